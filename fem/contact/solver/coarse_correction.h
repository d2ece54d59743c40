// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/compliance/envelope_factor.h"
#include "fem/contact/constraints/contact_rows.h"

namespace bullet_fem
{

/// The coarse level of a two-level method [Nicolaides 1987]: the wrenches between pairs of bodies, solved for all pairs
/// at once. Passing load from floor to floor of a tower takes a number of sweeps quadratic in its height, and the
/// remaining error, though small at every point, tilts it; the coarse level takes one solve. The points of a pair that
/// carry load share its force and moment in proportion to their loads; sliding points take the normal part only. Grows
/// with the problem, never shrinks.
class CoarseCorrection
{
public:
    /// The rows must outlive it.
    explicit CoarseCorrection(ContactRows& rows) : m_rows(rows) {}

    /// Call when the rows are assembled anew.
    void begin();

    /// Changes the impulses of these rows, all sides of which are in the working sets of their bodies, within their
    /// cones; the velocities follow. No effect if the factor would cost more than it saves, as in piles that are as
    /// wide as high.
    void correct(const std::vector<int>& working);

private:
    static constexpr int kUnknowns = 6;  // per pair: force and moment

    struct Pattern  // impulses of a row for unit values of its pair's unknowns
    {
        Vec3 m_of[kUnknowns];
        bool m_carries = false;
    };
    struct Pair
    {
        Range m_rows = {0, 0};       // range of working rows
        int m_owners[2] = {-1, -1};  // movers of the rows
        Vec3 m_center;
    };
    struct Side  // a pair at one of its owners
    {
        int m_owner, m_pair;
        bool m_isB;
    };

    void listPairs(const std::vector<int>& working);
    void addPair(const std::vector<int>& working, Range range);
    void sortPairs();
    void listSides();
    bool shapeFactor();
    void form(const std::vector<int>& working);
    void addYields(const std::vector<int>& working);
    void addOwner(const std::vector<int>& working, Range sides);
    void respond(const std::vector<int>& working, const Side& side, int unknown);
    const ConstraintSide& endOf(int row, const Side& side) const;
    Vec3 responseAt(int owner, const ConstraintSide& end);
    void addColumn(int pair, int other, int unknown, const Pattern& pattern, const Vec3& v);
    void addRow(int pair, int unknown, const Pattern& pattern, const Vec3& v);
    void residual(const std::vector<int>& working);
    Vec3 changeOf(int pair, int k) const;
    void apply(const std::vector<int>& working);

    // Calls use(pair, k, row) for working row k of every pair that carries something.
    template <class Use>
    void forEachCarrying(const std::vector<int>& working, const Use& use)
    {
        for (int p = 0; p < static_cast<int>(m_pairs.size()); ++p)
            for (int k = m_pairs[p].m_rows.m_begin; k < m_pairs[p].m_rows.m_end; ++k)
                if (m_patterns[k].m_carries) use(p, k, m_rows.rows()[working[k]]);
    }

    ContactRows& m_rows;
    std::vector<Pattern> m_patterns;  // per working row
    std::vector<Pair> m_pairs;
    std::vector<Side> m_sides;  // ordered by owner
    std::vector<int> m_first;   // per pair: the first pair with a common owner
    EnvelopeFactor m_factor;
    std::vector<unsigned char> m_held;
    std::vector<double> m_unknowns;
    std::vector<double> m_velocity;      // elastic velocities of the working set of one body
    std::vector<RigidMotion> m_motions;  // and its rigid motions
    Vec3 m_linear, m_angular;            // velocity of one rigid proxy
};

}  // namespace bullet_fem
