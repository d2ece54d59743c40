// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/coarse_correction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/contact/constraints/rigid_response.h"
#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

// Projection to the friction cone at fixed normal part; zero if that is not positive.
Vec3 nearestInCone(const ContactRow& row, const Vec3& impulse)
{
    const double normal = dot(impulse, row.m_axes[0]);
    if (!(normal > 0 && normal <= std::numeric_limits<double>::max())) return {};
    const Vec3 friction = impulse - normal * row.m_axes[0];
    const double most = row.m_friction * normal, length = norm(friction);
    return length > most ? normal * row.m_axes[0] + (most / length) * friction : impulse;
}

}  // namespace

void CoarseCorrection::begin()
{
    const std::vector<ContactRow>& all = m_rows.rows();
    const std::size_t rows = all.size();
    std::size_t pairs = 0, longest = 0, components = 0;
    for (std::size_t k = 0; k < rows; ++k)
        if (k == 0 || !sharesOwners(all[k], all[k - 1])) ++pairs;
    for (std::size_t b = 0; b < m_rows.problem().m_bodies.size(); ++b)
    {
        const WorkingSet& set = m_rows.body(static_cast<int>(b)).working();
        longest = std::max(longest, set.maxOrder());
        components = std::max(components, set.components());
    }
    m_motions.reserve(components);
    m_patterns.reserve(rows);
    m_pairs.reserve(pairs);
    m_sides.reserve(2 * pairs);
    m_first.reserve(pairs);
    m_held.reserve(kUnknowns * pairs);
    m_unknowns.reserve(kUnknowns * pairs);
    m_velocity.reserve(longest);
    // A factor of bandwidth w pairs takes 36 w^2 multiplications per pair, and has 4 w blocks: an upper bound by the
    // Cauchy-Schwarz inequality.
    const double widths = std::sqrt(static_cast<double>(pairs) * kMaxCoarseWork / 36);
    m_factor.reserve(2 * pairs, std::min(2 * pairs * (pairs + 1), static_cast<std::size_t>(4 * widths)));
}

void CoarseCorrection::correct(const std::vector<int>& working)
{
    listPairs(working);
    if (m_pairs.empty()) return;
    sortPairs();
    listSides();
    if (!shapeFactor()) return;
    form(working);
    residual(working);
    m_factor.solve(m_unknowns.data());
    apply(working);
}

// Rows of one pair are consecutive.
void CoarseCorrection::listPairs(const std::vector<int>& working)
{
    const std::vector<ContactRow>& rows = m_rows.rows();
    m_pairs.clear();
    m_patterns.assign(working.size(), Pattern());
    const int count = static_cast<int>(working.size());
    for (Range range = {0, 0}; range.m_begin < count; range.m_begin = range.m_end)
    {
        const ContactRow& first = rows[working[range.m_begin]];
        const auto isOther = [&](const ContactRow& row)
        { return row.m_joint != first.m_joint || row.m_torsion != first.m_torsion || !sharesOwners(row, first); };
        range.m_end = range.m_begin + 1;
        while (range.m_end < count && !isOther(rows[working[range.m_end]])) ++range.m_end;
        const auto isLink = [&](const ConstraintSide& end)
        { return end.m_rigidProxy >= 0 && m_rows.problem().m_rigidProxies[end.m_rigidProxy].m_responseCount > 0; };
        if (!first.m_joint && !first.m_torsion && !isLink(first.m_a) && !isLink(first.m_b)) addPair(working, range);
    }
}

void CoarseCorrection::addPair(const std::vector<int>& working, Range range)
{
    const std::vector<ContactRow>& rows = m_rows.rows();
    const auto normalOf = [&rows, &working](int k)
    {
        const ContactRow& row = rows[working[k]];
        return row.m_idle ? 0.0 : std::max(0.0, dot(row.m_impulse, row.m_axes[0]));
    };
    double load = 0, square = 0;
    Vec3 moment;
    for (int k = range.m_begin; k < range.m_end; ++k)
    {
        load += normalOf(k);
        moment += normalOf(k) * m_rows.pointOf(working[k]);
    }
    if (!(load > 0)) return;
    Pair pair;
    pair.m_rows = range;
    pair.m_owners[0] = m_rows.mover(rows[working[range.m_begin]].m_a);
    pair.m_owners[1] = m_rows.mover(rows[working[range.m_begin]].m_b);
    pair.m_center = (1 / load) * moment;
    for (int k = range.m_begin; k < range.m_end; ++k)
    {
        const Vec3 offset = m_rows.pointOf(working[k]) - pair.m_center;
        square += normalOf(k) / load * dot(offset, offset);
    }
    const double perLength =
        square > 0 ? 1 / std::sqrt(square) : 0;  // moments are expressed as forces at that distance
    for (int k = range.m_begin; k < range.m_end; ++k)
    {
        const ContactRow& row = rows[working[k]];
        const double normal = normalOf(k);
        Pattern& pattern = m_patterns[k];
        pattern.m_carries = normal > 0;
        const bool slides = !sticks(row);
        const Vec3 offset = perLength * (m_rows.pointOf(working[k]) - pair.m_center);
        for (int c = 0; c < kUnknowns; ++c)
        {
            Vec3 unit;
            unit[c % 3] = 1;
            Vec3 share = (normal / load) * (c < 3 ? unit : cross(unit, offset));
            if (slides) share = dot(share, row.m_axes[0]) * row.m_axes[0];
            pattern.m_of[c] = share;
        }
    }
    m_pairs.push_back(pair);
}

// Sorted along the longest extent, so that the factor of a tower is narrow.
void CoarseCorrection::sortPairs()
{
    Vec3 low = m_pairs[0].m_center, high = low;
    for (const Pair& pair : m_pairs)
        for (int i = 0; i < 3; ++i)
        {
            low[i] = std::min(low[i], pair.m_center[i]);
            high[i] = std::max(high[i], pair.m_center[i]);
        }
    const Vec3 extent = high - low;
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (extent[i] > extent[axis]) axis = i;
    const auto isBefore = [axis](const Pair& a, const Pair& b)
    {
        const double x = a.m_center[axis], y = b.m_center[axis];
        return x < y || (x == y && a.m_rows.m_begin < b.m_rows.m_begin);
    };
    std::sort(m_pairs.begin(), m_pairs.end(), isBefore);
}

void CoarseCorrection::listSides()
{
    m_sides.clear();
    for (int p = 0; p < static_cast<int>(m_pairs.size()); ++p)
        for (int side = 0; side < 2; ++side)
            if (m_pairs[p].m_owners[side] >= 0) m_sides.push_back({m_pairs[p].m_owners[side], p, side == 1});
    const auto isBefore = [](const Side& a, const Side& b)
    { return a.m_owner < b.m_owner || (a.m_owner == b.m_owner && a.m_pair < b.m_pair); };
    std::sort(m_sides.begin(), m_sides.end(), isBefore);
}

// False if the factor would be too wide.
bool CoarseCorrection::shapeFactor()
{
    const int pairs = static_cast<int>(m_pairs.size());
    m_first.resize(m_pairs.size());
    for (int p = 0; p < pairs; ++p) m_first[p] = p;
    int first = 0;
    for (std::size_t k = 0; k < m_sides.size(); ++k)
    {
        if (k == 0 || m_sides[k].m_owner != m_sides[k - 1].m_owner) first = m_sides[k].m_pair;
        m_first[m_sides[k].m_pair] = std::min(m_first[m_sides[k].m_pair], first);
    }
    double work = 0;
    for (int p = 0; p < pairs; ++p) work += 2 * EnvelopeFactor::work(2.0 * (p - m_first[p] + 1));
    if (work > kMaxCoarseWork) return false;
    m_factor.clear();
    for (int p = 0; p < pairs; ++p)
        for (int half = 0; half < 2; ++half) m_factor.addRow(2 * m_first[p]);
    return true;
}

void CoarseCorrection::form(const std::vector<int>& working)
{
    addYields(working);
    const int count = static_cast<int>(m_sides.size());
    for (Range owner = {0, 0}; owner.m_begin < count; owner.m_begin = owner.m_end)
    {
        while (owner.m_end < count && m_sides[owner.m_end].m_owner == m_sides[owner.m_begin].m_owner) ++owner.m_end;
        addOwner(working, owner);
    }
    m_held.assign(kUnknowns * m_pairs.size(), 0);
    m_factor.factor(m_held.data());
}

void CoarseCorrection::addYields(const std::vector<int>& working)
{
    forEachCarrying(working,
                    [this](int p, int k, const ContactRow& row)
                    {
                        const Vec3& n = row.m_axes[0];
                        for (int c = 0; c < kUnknowns; ++c)
                            addColumn(p, p, c, m_patterns[k], row.m_yield.x * dot(m_patterns[k].m_of[c], n) * n);
                    });
}

// Couplings of the unknowns of an owner's pairs through that owner.
void CoarseCorrection::addOwner(const std::vector<int>& working, Range sides)
{
    for (int s = sides.m_begin; s < sides.m_end; ++s)
        for (int c = 0; c < kUnknowns; ++c)
        {
            const Side& from = m_sides[s];
            respond(working, from, c);
            for (int t = s; t < sides.m_end; ++t)
            {
                const Side& to = m_sides[t];
                const Range rows = m_pairs[to.m_pair].m_rows;
                for (int k = rows.m_begin; k < rows.m_end; ++k)
                {
                    if (!m_patterns[k].m_carries) continue;
                    const Vec3 v = (to.m_isB ? -1.0 : 1.0) * responseAt(to.m_owner, endOf(working[k], to));
                    addColumn(to.m_pair, from.m_pair, c, m_patterns[k], v);
                    if (to.m_pair == from.m_pair && t != s) addRow(to.m_pair, c, m_patterns[k], v);
                }
            }
        }
}

const ConstraintSide& CoarseCorrection::endOf(int row, const Side& side) const
{
    return side.m_isB ? m_rows.rows()[row].m_b : m_rows.rows()[row].m_a;
}

// Velocities of a body's working set, or of a rigid proxy, for a unit value of an unknown.
void CoarseCorrection::respond(const std::vector<int>& working, const Side& side, int unknown)
{
    const double sign = side.m_isB ? -1 : 1;
    const Range rows = m_pairs[side.m_pair].m_rows;
    const int bodies = static_cast<int>(m_rows.problem().m_bodies.size());
    Vec3 force, torque;
    if (side.m_owner < bodies)
    {
        m_motions.assign(m_rows.body(side.m_owner).working().components(), RigidMotion());
        m_velocity.assign(m_rows.body(side.m_owner).working().order(), 0.0);
    }
    for (int k = rows.m_begin; k < rows.m_end; ++k)
    {
        if (!m_patterns[k].m_carries) continue;
        const ConstraintSide& end = endOf(working[k], side);
        const Vec3 impulse = sign * m_patterns[k].m_of[unknown];
        if (side.m_owner < bodies)
        {
            const WorkingSet& set = m_rows.body(side.m_owner).working();
            set.respond(end.m_end, impulse, m_velocity);
            set.pushRigid(end.m_end, impulse, m_motions);
        }
        force += impulse;
        torque += cross(end.m_arm, impulse);
    }
    if (side.m_owner < bodies) return;
    const RigidProxy& rigidProxy = m_rows.problem().m_rigidProxies[side.m_owner - bodies];
    m_linear = scaled(rigidProxy.m_inverseMass, force);
    m_angular = rigidProxy.m_inverseInertia * torque;
}

Vec3 CoarseCorrection::responseAt(int owner, const ConstraintSide& end)
{
    if (owner < static_cast<int>(m_rows.problem().m_bodies.size()))
        return m_rows.body(owner).working().read(end.m_end, m_velocity, m_motions);
    return m_linear + cross(m_angular, end.m_arm);
}

// A column of the blocks between two pairs, `pair` not before `other` (for a diagonal block a row): the velocity at the
// points of a pattern for a unit value of an unknown.
void CoarseCorrection::addColumn(int pair, int other, int unknown, const Pattern& pattern, const Vec3& v)
{
    for (int i = 0; i < kUnknowns; ++i)
        if (pair > other || i / 3 >= unknown / 3)
            m_factor.add(kUnknowns * pair + i, kUnknowns * other + unknown, dot(pattern.m_of[i], v));
}

void CoarseCorrection::addRow(int pair, int unknown, const Pattern& pattern, const Vec3& v)
{
    for (int i = 0; i <= unknown / 3 * 3 + 2; ++i)
        m_factor.add(kUnknowns * pair + unknown, kUnknowns * pair + i, dot(pattern.m_of[i], v));
}

// Residual: target velocities of the rows minus their velocities.
void CoarseCorrection::residual(const std::vector<int>& working)
{
    m_unknowns.assign(kUnknowns * m_pairs.size(), 0);
    forEachCarrying(working,
                    [this](int p, int k, const ContactRow& row)
                    {
                        const Vec3 v = m_rows.velocity(row);
                        Vec3 missing;
                        for (int i = 0; i < 3; ++i)
                            missing += (row.m_target[i] - dot(row.m_axes[i], v)) * row.m_axes[i];
                        missing -= row.m_yield.x * dot(row.m_axes[0], row.m_impulse) * row.m_axes[0];
                        for (int c = 0; c < kUnknowns; ++c)
                            m_unknowns[kUnknowns * p + c] += dot(m_patterns[k].m_of[c], missing);
                    });
}

Vec3 CoarseCorrection::changeOf(int pair, int k) const
{
    Vec3 change;
    for (int c = 0; c < kUnknowns; ++c) change += m_unknowns[kUnknowns * pair + c] * m_patterns[k].m_of[c];
    return change;
}

void CoarseCorrection::apply(const std::vector<int>& working)
{
    forEachCarrying(working, [this](int p, int k, ContactRow& row)
                    { m_rows.change(row, nearestInCone(row, row.m_impulse + changeOf(p, k))); });
}

}  // namespace bullet_fem
