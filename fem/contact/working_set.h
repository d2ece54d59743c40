// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "fem/contact/point_compliance.h"

namespace bullet_fem
{

/// The sides of a body whose impulses change in the sweeps, their velocities, and the dense compliance between them:
/// three quarters of the candidate points carry no impulse, and without them a sweep stays in the cache. The set
/// changes often and by little: a side keeps its position, and one that leaves is kept, with correct velocity, until
/// many have left. Grows, never shrinks.
class WorkingSet
{
public:
    /// Removes all sides, for a body with this many. The compliance may have changed.
    void reset(int ends);

    /// Begins another choice of sides: add() each, repetitions allowed, then pack(), with the slot values of the
    /// compliance.
    void choose();
    void add(int e);
    void pack(PointCompliance& points, const std::vector<double>& slotVelocity);

    /// Sets all velocities anew.
    void load(const PointCompliance& points, const std::vector<double>& slotVelocity);

    /// True for the sides of the last choice, and some that have left.
    bool has(int e) const { return m_place[e] >= 0; }
    const std::vector<int>& ends() const { return m_ends; }

    /// Velocity of a side of the set [m/s].
    Vec3 velocity(int e) const { return at(m_velocity, m_place[e]); }

    /// Adds an impulse to a side of the set; the velocities follow.
    void push(int e, const Vec3& impulse)
    {
        const Response response = respond(m_place[e], impulse);
        addResponses(&response, 1, order(), m_velocity.data());
    }

    /// Response of all sides of the set to an impulse on one, order() values; and interpolation of such values at a
    /// side.
    Response response(int e, const Vec3& impulse) const { return respond(m_place[e], impulse); }
    Vec3 read(int e, const std::vector<double>& values) const { return at(values, m_place[e]); }
    std::size_t order() const { return padded(3 * m_ends.size(), kResponsePadding); }

    /// For AndersonAcceleration: the velocities after the last sweep, and their differences from those of earlier
    /// sweeps; noteSweep stores the difference of this sweep in a slot, and the first sweep has none. mixSweeps
    /// subtracts multiples of them.
    static constexpr int kMixed = 2;
    void noteSweep(int slot, bool first);
    void mixSweeps(const std::array<double, kMixed>& shares);

private:
    static Vec3 at(const std::vector<double>& values, int place)
    {
        const double* v = &values[3 * static_cast<std::size_t>(place)];
        return {v[0], v[1], v[2]};
    }
    static void put(const Vec3& v, std::vector<double>& values, std::size_t place);
    float* block(std::size_t e, std::size_t f) { return &m_W[3 * f * m_stride + 3 * e]; }
    Response respond(std::size_t place, const Vec3& impulse) const
    {
        return {&m_W[3 * place * m_stride], m_stride, impulse};
    }
    std::size_t wantedStride(std::size_t ends) const;
    void widen();
    void dropThoseThatLeft();

    std::vector<int> m_ends;              // sides of the body
    std::vector<int> m_place;             // index of each of the body's sides in the set, or -1
    std::vector<unsigned char> m_wanted;  // per side of the set: in the last choice
    std::size_t m_packed = 0;             // number of sides in m_W
    std::size_t m_stride = 0;             // stride of its columns
    std::vector<float> m_W;               // three columns per side, with room for all sides of the body
    std::vector<double> m_velocity;       // three per side of the set, padded
    std::vector<double> m_swept;          // velocities after the last sweep, three per side of the set, padded
    std::array<std::vector<double>, kMixed> m_sweptDelta;
};

}  // namespace bullet_fem
