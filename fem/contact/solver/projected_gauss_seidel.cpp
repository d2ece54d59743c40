// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/projected_gauss_seidel.h"

#include <algorithm>
#include <array>
#include <limits>

#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

// NaN is never applied.
constexpr double kMax = std::numeric_limits<double>::max();  // maximum squared impulse [N2 s2]

// True if the impulse is in its friction cone up to rounding; Anderson mixing may leave it.
bool isInCone(const ContactRow& row)
{
    constexpr double kWiderBy = 1e-3;  // share of the friction limit
    const double normal = dot(row.m_impulse, row.m_axes[0]), most = (1 + kWiderBy) * row.m_friction * normal;
    return !row.m_torsion && normal >= 0 && dot(row.m_impulse, row.m_impulse) - normal * normal <= most * most;
}

}  // namespace

void ProjectedGaussSeidel::begin()
{
    if (!m_rows.isDense()) return;
    const std::size_t rows = m_rows.rows().size();
    m_working.reserve(rows);
    m_works.assign(rows, 0);
    m_mixing.begin();
    m_coarse.begin();
    m_newton.begin();
    restart();
    divideRows();
}

// Joints are swept in their order, and links of one multibody are coupled: then there is one part.
void ProjectedGaussSeidel::divideRows()
{
    const ContactProblem& problem = m_rows.problem();
    const std::vector<ContactRow>& rows = m_rows.rows();
    const auto isLink = [](const RigidProxy& rigidProxy) { return rigidProxy.m_responseCount > 0; };
    m_parts.clear(static_cast<int>(m_rows.movers()));
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (!rows[k].m_joint) m_parts.add(m_rows.mover(rows[k].m_a), m_rows.mover(rows[k].m_b), m_rows.pointOf(k));
    m_parts.divide(problem.m_joints.empty() &&
                   std::none_of(problem.m_rigidProxies.begin(), problem.m_rigidProxies.end(), isLink));
}

void ProjectedGaussSeidel::restart()
{
    m_lifeOfSet = -1;
    m_looked = m_hasSwept = false;
    m_newton.restart();
}

// Most candidate points never carry an impulse: some sweeps skip them. The working set has the rows with an impulse,
// rows that require one, and joints. After changes it is chosen anew sooner.
void ProjectedGaussSeidel::chooseWorkingSet()
{
    if (!m_looked) lookForWork();
    m_looked = false;
    m_working.clear();
    const std::vector<ContactRow>& rows = m_rows.rows();
    m_needsNone = needsNone();
    m_joints.work(!m_needsNone);
    int joined = 0;
    for (std::size_t k = 0; k < rows.size() && !m_needsNone; ++k)
    {
        if (m_rows.wants(k)) m_working.push_back(static_cast<int>(k));
        if (m_rows.wants(k) && !m_works[k]) ++joined;
        m_works[k] = m_rows.wants(k) ? 1 : 0;
    }
    m_parts.sort(m_working);
    m_rows.forEachContactBody(nullptr, [this](int b) { m_rows.body(b).choose(); });
    for (int k : m_working)
        for (const ConstraintSide* end : {&rows[k].m_a, &rows[k].m_b})
            if (end->m_body >= 0) m_rows.body(end->m_body).work(end->m_end);
    m_rows.forEachContactBody(m_rows.threadsForCompliance(), [this](int b) { m_rows.body(b).startWork(); });
    m_mixing.start(m_working);
    m_lifeOfSet = joined > kJoinedShare * static_cast<double>(m_working.size()) ? kShortLife : kWorkingSetSweeps;
}

bool ProjectedGaussSeidel::needsNone() const
{
    return m_joints.goAtOnce() && m_rows.rows().size() == m_rows.problem().m_joints.size();
}

void ProjectedGaussSeidel::lookForWork()
{
    m_rows.flush();
    m_rows.noteWants();
    m_looked = true;
}

// If rows outside the working set require a change above the tolerance, the next sweep chooses another working set.
bool ProjectedGaussSeidel::restIsDone(double tolerance)
{
    const std::vector<ContactRow>& rows = m_rows.rows();
    if (m_needsNone || m_working.size() == rows.size()) return true;
    lookForWork();
    m_lifeOfSet = -1;
    double largest = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (m_rows.wants(k) && !m_works[k]) largest = std::max(largest, m_rows.wantedSpeed(rows[k]));
    return m_rows.share(largest) <= tolerance;
}

void ProjectedGaussSeidel::end()
{
    if (m_hasSwept) m_coarse.correct(m_working);
    m_hasSwept = false;
}

bool ProjectedGaussSeidel::sweep(double tolerance)
{
    if (m_lifeOfSet <= 0 || m_needsNone != needsNone()) chooseWorkingSet();
    --m_lifeOfSet;
    m_hasSwept = true;
    const bool mixes = m_rows.rows().size() > m_rows.problem().m_joints.size();
    m_negligible = kNegligible * tolerance * m_rows.speedScale();
    if (mixes) m_mixing.mix(m_working);
    sweepAll();
    if (mixes && m_rows.isRunaway(m_lastSpeed) && m_mixing.takeBack(m_working)) sweepAll();
    if (m_lastChange <= tolerance && m_negligible > 0)
    {
        m_negligible = 0;
        sweepAll();
    }
    if (mixes) m_mixing.note(m_working);
    if (m_lastChange > tolerance && !m_rows.isRunaway(m_lastSpeed) && m_newton.step(m_working, m_lastChange, tolerance))
        m_mixing.start(m_working);
    return m_lastChange > tolerance || !restIsDone(tolerance);
}

void ProjectedGaussSeidel::sweepAll()
{
    std::array<double, SweepParts::kMax> changes;
    m_parts.inTurn(m_rows.settings().m_step.m_threads, [&](int part, Range rows) { changes[part] = sweepRows(rows); });
    m_lastSpeed = *std::max_element(changes.begin() + 1, changes.begin() + m_parts.parts());
    m_lastChange = m_rows.share(std::max(m_lastSpeed, m_joints.solve()));
}

// Sweeps the working rows, one pair of owners after another. A pair with large changes is swept again immediately,
// while its data are in the cache; the returned change is that of the first pass. A diverging sweep ends at once:
// impulses would grow by orders of magnitude per row, and leave rounding errors when removed. Returns the maximum
// change [m/s], as sweepOnce does.
double ProjectedGaussSeidel::sweepRows(Range rows)
{
    const double much = std::max(kResweepError, m_rows.settings().m_tolerance);
    double largest = 0;
    for (Range pair = {rows.m_begin, rows.m_begin}; pair.m_begin < rows.m_end; pair.m_begin = pair.m_end)
    {
        pair.m_end = endOfPair(pair.m_begin, rows.m_end);
        double change = sweepOnce(pair);
        largest = std::max(largest, change);
        for (int k = 1; k < kMaxResweeps && m_rows.share(change) > much && !m_rows.isRunaway(change); ++k)
            change = sweepOnce(pair);
        if (m_rows.isRunaway(change)) return change;
    }
    return largest;
}

// The consecutive rows from one on with equal owners.
int ProjectedGaussSeidel::endOfPair(int begin, int end) const
{
    const std::vector<ContactRow>& rows = m_rows.rows();
    int k = begin + 1;
    while (k < end && sharesOwners(rows[m_working[k]], rows[m_working[begin]])) ++k;
    return k;
}

double ProjectedGaussSeidel::sweepOnce(Range rows)
{
    double largest = 0;
    for (int k = rows.m_begin; k < rows.m_end; ++k)
    {
        ContactRow& row = m_rows.rows()[m_working[k]];
        if (row.m_joint) continue;
        const Vec3 wanted = wantedImpulse(row, row.m_impulse, m_rows.velocity(row), 1);
        const Vec3 difference = wanted - row.m_impulse;
        const double square = dot(difference, difference);
        if (!(square > 0 && square <= kMax)) continue;
        const double speed = speedOf(row, difference);
        largest = std::max(largest, speed);
        if (speed <= m_negligible && isInCone(row)) continue;
        m_rows.change(row, wanted);
        if (m_rows.isRunaway(largest)) break;
    }
    return largest;
}

}  // namespace bullet_fem
