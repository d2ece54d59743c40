// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/contact_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bullet_fem
{
namespace
{

// A pair of ends is swept again where it has just changed by more than this share of the speed scale, and by more than
// the tolerance: finer errors are between the pairs, not within them.
constexpr double kMuch = 5e-3;
constexpr int kMostTimes = 8;

constexpr int kSweepsBetween = 5;  // minimizations: they find out what touches, slides and sticks

// What is no number is never applied.
constexpr double kMost = std::numeric_limits<double>::max();  // of an impulse's square [N2 s2]

// Impacts change velocities by the speed scale, and now and then by some tens of it.
constexpr double kRunaway = 1e3;

}  // namespace

// What only some solves use: which of them is the first shall not matter.
void ContactRows::reserve()
{
    m_working.reserve(m_rows.size());
    m_saved.reserve(m_rows.size());
    for (std::vector<unsigned char>* flags : {&m_works, &m_wants}) flags->assign(m_rows.size(), 0);
    for (std::vector<Vec3>* saved : {&m_savedLinear, &m_savedAngular}) saved->reserve(m_problem->m_obstacles.size());
    m_pushed.reserve(m_problem->m_bodies.size());
    m_runaways.reserve(m_problem->m_bodies.size() + m_problem->m_obstacles.size());
}

// The impulse that a contact wants for a relative velocity it has at another impulse; step: share of the way.
Vec3 ContactRows::solveContact(const Row& row, const Vec3& impulse, Vec3 v, double step) const
{
    // Normal: n . v + yield lambda >= target.
    const Vec3 n = row.m_axes[0];
    const double old = dot(impulse, n);
    const double missing = row.m_target.x - dot(n, v) - row.m_yield.x * old;
    if (!(old > 0 || missing > 0)) return {};
    const double normal = std::max(0.0, old + step * missing / (row.m_rowCompliance.x + row.m_yield.x));
    if (!(normal > 0)) return {};
    if (step == 1) v += row.m_compliance * ((normal - old) * n);

    // Friction: a step along the sliding velocity, projected to the disc of radius mu lambda_n.
    Vec3 tangential;
    for (int i = 1; i < 3; ++i)
        tangential +=
            (dot(impulse, row.m_axes[i]) + step * (row.m_target[i] - dot(v, row.m_axes[i])) / row.m_rowCompliance[i]) *
            row.m_axes[i];
    const double radius = row.m_friction * normal, length = norm(tangential);
    if (length > radius) tangential *= length > 0 ? radius / length : 0;
    return normal * n + tangential;
}

Vec3 ContactRows::solveJoint(const Row& row, const Vec3& impulse, Vec3 v, double step) const
{
    Vec3 result;
    for (int i = 0; i < 3; ++i)
    {
        const Vec3& axis = row.m_axes[i];
        const double w = row.m_rowCompliance[i], old = dot(impulse, axis), yield = row.m_yield[i];
        double wanted = 0;
        if (w > 0)
        {
            const double missing = row.m_target[i] - dot(axis, v) - yield * old;
            wanted = std::clamp(old + step * missing / (w + yield), -row.m_limit[i], row.m_limit[i]);
        }
        result += wanted * axis;
        if (step == 1) v += row.m_compliance * ((wanted - old) * axis);
    }
    const double length = norm(result);
    if (length > row.m_most) result *= row.m_most / length;
    return result;
}

Vec3 ContactRows::solveRow(const Row& row, const Vec3& impulse, const Vec3& v, double step) const
{
    if (row.m_idle) return impulse;
    return row.m_joint ? solveJoint(row, impulse, v, step) : solveContact(row, impulse, v, step);
}

bool ContactRows::sweep(double tolerance)
{
    m_lastChange = 0;
    if (!m_inTurn) return sweepAtOnce() > tolerance;
    if (m_lifeOfSet < 0) chooseWorkingSet();
    if (m_problem->m_joints.empty() && m_subspace.m_sweeps == kSweepsBetween) searchSubspace();
    if (m_lifeOfSet == 0) chooseWorkingSet();
    ++m_subspace.m_sweeps;
    --m_lifeOfSet;
    m_lastChange = sweepInTurn();
    return m_lastChange > tolerance || !restIsDone(tolerance);
}

double ContactRows::sweepInTurn()
{
    std::array<Swept, SweepParts::kMost> swept;
    m_parts.inTurn(m_settings.m_step.m_threads, [&](int part, Range rows) { swept[part] = sweepRows(rows); });
    double largest = 0;
    m_subspace.m_sweepWork = 0;
    for (int part = 1; part < m_parts.parts(); ++part)
    {
        largest = std::max(largest, swept[part].m_largest);
        m_subspace.m_sweepWork += swept[part].m_work;
    }
    m_lastSpeed = largest;
    return share(largest);
}

// Of the working ones, one pair of ends after another. Where that has much to do it is swept again at once, while what
// its impulses move is in the cache; the changes that count are those of the first time. What runs away ends it where
// it is: impulses would grow by orders of magnitude a row, and leave their rounding when they are taken back.
ContactRows::Swept ContactRows::sweepRows(Range rows)
{
    const double much = std::max(kMuch, m_settings.m_tolerance);
    const bool again = m_problem->m_joints.empty();
    Swept swept;
    for (Range pair = {rows.m_begin, rows.m_begin}; pair.m_begin < rows.m_end; pair.m_begin = pair.m_end)
    {
        pair.m_end = endOfPair(pair.m_begin, rows.m_end);
        const Swept first = sweepOnce(pair);
        swept.m_largest = std::max(swept.m_largest, first.m_largest);
        swept.m_work += first.m_work;
        double change = first.m_largest;
        for (int k = 1; again && k < kMostTimes && share(change) > much && !isRunaway(change); ++k)
            change = sweepOnce(pair).m_largest;
        if (!isRunaway(change)) continue;
        swept.m_largest = change;
        break;
    }
    return swept;
}

// The rows from one on that have the same two ends' owners.
int ContactRows::endOfPair(int begin, int end) const
{
    const Row& first = m_rows[m_working[begin]];
    int k = begin + 1;
    while (k < end && m_rows[m_working[k]].m_a.sharesOwner(first.m_a) &&
           m_rows[m_working[k]].m_b.sharesOwner(first.m_b))
        ++k;
    return k;
}

ContactRows::Swept ContactRows::sweepOnce(Range rows)
{
    Swept swept;
    for (int k = rows.m_begin; k < rows.m_end; ++k)
    {
        Row& row = m_rows[m_working[k]];
        const Vec3 wanted = solveRow(row, row.m_impulse, velocity(row), 1);
        const Vec3 difference = wanted - row.m_impulse;
        const double square = dot(difference, difference);
        if (!(square > 0 && square <= kMost)) continue;
        swept.m_largest = std::max(swept.m_largest, speedOf(row, difference));
        swept.m_work += row.m_rowCompliance.x * square;
        change(row, wanted);
        if (isRunaway(swept.m_largest)) break;
    }
    return swept;
}

bool ContactRows::isRunaway(double speed) const
{
    return m_speedScale > 0 && !(speed <= kRunaway * m_speedScale);
}

void ContactRows::letGo()
{
    const std::size_t bodies = m_problem->m_bodies.size();
    m_runaways.assign(bodies + m_problem->m_obstacles.size(), 0);
    const auto forMovableEnds = [&](const Row& row, const auto& visit)
    {
        for (const RowEnd* end : {&row.m_a, &row.m_b})
        {
            if (end->m_body >= 0) visit(m_runaways[end->m_body]);
            if (end->m_obstacle >= 0 && m_problem->m_obstacles[end->m_obstacle].canMove())
                visit(m_runaways[bodies + end->m_obstacle]);
        }
    };
    for (const Row& row : m_rows)
        if (!(speedOf(row, row.m_impulse) <= m_speedScale)) forMovableEnds(row, [](unsigned char& runs) { runs = 1; });
    for (Row& row : m_rows)
    {
        bool runs = false;
        forMovableEnds(row, [&runs](unsigned char end) { runs = runs || end; });
        if (!runs) continue;
        change(row, {});
        row.m_idle = true;
    }
    flush();
    m_subspace = {};
    forgetWorkingSet();
    restart();
}

double ContactRows::share(double speed) const
{
    return speed > 0 ? speed / std::max(m_speedScale, 1e-3 * speed) : 0;
}

// The gradient step: one over the largest eigenvalue of the compliance, scaled by that of every row, by power
// iterations from the present impulses. These have the shape of its mode, so few are enough.
void ContactRows::chooseStep()
{
    constexpr int kIterations = 8;
    constexpr double kSafety = 1.2, kSettled = 1.05;
    double eigenvalue = 1;
    for (Row& row : m_rows)  // probes: added to the impulses and taken back at the end
    {
        row.m_roundImpulse = row.m_impulse;
        row.m_lastVelocity = velocity(row);
        const double length = norm(row.m_impulse);
        row.m_lastImpulse = length > 0 ? (1 / length) * row.m_impulse : row.m_axes[0];
        row.m_lastImpulse *= 1 / std::sqrt(std::max(row.m_rowCompliance.x, 1e-300));
    }
    for (int k = 0; k < kIterations; ++k)
    {
        double sum = 0, sum2 = 0;
        for (const Row& row : m_rows)
            if (!row.m_idle) sum += row.m_rowCompliance.x * dot(row.m_lastImpulse, row.m_lastImpulse);
        const double unit = sum > 0 ? 1 / std::sqrt(sum) : 0;
        for (Row& row : m_rows)
            if (!row.m_idle) change(row, row.m_roundImpulse + unit * row.m_lastImpulse);
        flush();
        for (Row& row : m_rows)
        {
            if (row.m_idle) continue;
            row.m_lastImpulse = (1 / row.m_rowCompliance.x) * (velocity(row) - row.m_lastVelocity);
            sum2 += row.m_rowCompliance.x * dot(row.m_lastImpulse, row.m_lastImpulse);
        }
        const double before = eigenvalue;
        eigenvalue = std::max(before, std::sqrt(sum2));
        if (k > 0 && eigenvalue < kSettled * before) break;
    }
    for (Row& row : m_rows) change(row, row.m_roundImpulse);
    flush();
    m_gradientStep = 1 / (kSafety * eigenvalue);
    for (Row& row : m_rows)
    {
        row.m_lastImpulse = row.m_impulse;
        row.m_lastVelocity = velocity(row);
    }
}

double ContactRows::sweepAtOnce()
{
    if (!(m_gradientStep > 0)) chooseStep();
    // Nesterov's extrapolation from the last two points, with restart where it points uphill [O'Donoghue, Candes 2015].
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * m_acceleration * m_acceleration));
    const double beta = (m_acceleration - 1) / next;
    double largest = 0, uphill = 0;
    for (Row& row : m_rows)
    {
        const Vec3 v = velocity(row), before = row.m_impulse;
        const Vec3 from = before + beta * (before - row.m_lastImpulse);
        const Vec3 wanted = solveRow(row, from, v + beta * (v - row.m_lastVelocity), m_gradientStep);
        uphill += row.m_rowCompliance.x * dot(from - wanted, wanted - before);
        row.m_lastImpulse = before;
        row.m_lastVelocity = v;
        largest = std::max(largest, speedOf(row, wanted - before));
        row.m_pending = wanted;
    }
    for (Row& row : m_rows) change(row, row.m_pending);
    flush();
    m_lastSpeed = largest;
    m_acceleration = uphill > 0 ? 1 : next;
    return error();
}

}  // namespace bullet_fem
