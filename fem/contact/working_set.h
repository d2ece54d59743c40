// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "fem/contact/point_compliance.h"

namespace bullet_fem
{

/// The ends of a body whose impulses change in the sweeps, their velocities, and the dense compliance between them:
/// three quarters of the points that are found near a surface carry nothing, and without them a sweep stays in the
/// cache. The set changes often and by little: an end keeps its place, and one that leaves stays, its velocity right,
/// until many have left. Grows, never shrinks.
class WorkingSet
{
public:
    /// Forgets all ends, of which the body has so many. The compliance may have changed.
    void reset(int ends);

    /// Begins another choice of ends: add() each, once or again, then pack(), with what the slots of the compliance
    /// have.
    void choose();
    void add(int e);
    void pack(PointCompliance& points, const std::vector<double>& slotVelocity);

    /// Takes all velocities anew.
    void load(const PointCompliance& points, const std::vector<double>& slotVelocity);

    /// True for the ends of the last choice, and some that have left.
    bool has(int e) const { return m_place[e] >= 0; }
    const std::vector<int>& ends() const { return m_ends; }

    /// Of an end of the set [m/s].
    Vec3 velocity(int e) const { return at(m_velocity, m_place[e]); }

    /// Adds an impulse to one; the velocities follow.
    void push(int e, const Vec3& impulse)
    {
        const Response response = respond(m_place[e], impulse);
        addResponses(&response, 1, order(), m_velocity.data());
    }

    /// What an impulse on one does to all of them, order() numbers; and what is at one of such numbers.
    Response response(int e, const Vec3& impulse) const { return respond(m_place[e], impulse); }
    Vec3 read(int e, const std::vector<double>& values) const { return at(values, m_place[e]); }
    std::size_t order() const { return padded(3 * m_ends.size(), kResponsePadding); }

    /// For AndersonAcceleration: the velocities after the last sweep, and their differences from those of the sweeps
    /// before, of which noteSweep keeps that of this one in a slot; the first has none. mixSweeps takes shares of them
    /// off.
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

    std::vector<int> m_ends;              // of the body
    std::vector<int> m_place;             // of the body's ends in the set, or -1
    std::vector<unsigned char> m_wanted;  // per end of the set: belongs to the last choice
    std::size_t m_packed = 0;             // ends that m_W has
    std::size_t m_stride = 0;             // of its columns
    std::vector<float> m_W;               // three columns an end, with room for all ends of the body
    std::vector<double> m_velocity;       // three an end of the set, padded
    std::vector<double> m_swept;          // likewise, after the last sweep
    std::array<std::vector<double>, kMixed> m_sweptDelta;
};

}  // namespace bullet_fem
