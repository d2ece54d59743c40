// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "fem/contact/compliance/point_compliance.h"

namespace bullet_fem
{

/// The sides of a body whose impulses change in the sweeps, their velocities, and the dense compliance between them:
/// three quarters of the candidate points carry no impulse, and without them a sweep stays in the cache. The set
/// changes often and by little: a side keeps its position, and one that leaves is kept, with correct velocity, until
/// many have left. Grows, never shrinks.
class WorkingSet
{
public:
    /// Removes all sides, for a body with this many, and this many components. The compliance may have changed.
    void reset(int ends, int components);

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
    Vec3 velocity(int e) const { return read(e, m_velocity, m_motion); }

    /// Adds an impulse to a side of the set; the velocities follow.
    void push(int e, const Vec3& impulse)
    {
        const Response response = respond(m_place[e], impulse);
        addResponses(&response, 1, order(), m_velocity.data());
        pushRigid(e, impulse, m_motion);
    }

    /// Elastic response of all sides of the set to an impulse on one, order() values, and the rigid one of its
    /// component; velocity of a side with such values and motions.
    Response response(int e, const Vec3& impulse) const { return respond(m_place[e], impulse); }
    void pushRigid(int e, const Vec3& impulse, std::vector<RigidMotion>& motions) const
    {
        const RigidSide& rigid = m_rigid[m_place[e]];
        if (rigid.component() >= 0) motions[rigid.component()] += rigid.response(impulse);
    }
    Vec3 read(int e, const std::vector<double>& values, const std::vector<RigidMotion>& motions) const
    {
        const RigidSide& rigid = m_rigid[m_place[e]];
        const Vec3 elastic = at(values, m_place[e]);
        return rigid.component() >= 0 ? elastic + rigid.velocity(motions[rigid.component()]) : elastic;
    }
    std::size_t components() const { return m_motion.size(); }
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

    // Calls visit(value, k) for all velocities and motions.
    template <class Visit>
    void forEachValue(const Visit& visit)
    {
        std::size_t k = 0;
        for (; k < 3 * m_ends.size(); ++k) visit(m_velocity[k], k);
        for (RigidMotion& motion : m_motion)
            for (Vec3* part : {&motion.m_linear, &motion.m_angular})
                for (int i = 0; i < 3; ++i) visit((*part)[i], k++);
    }
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
    std::vector<RigidSide> m_rigid;       // per side of the set
    std::vector<double> m_velocity;       // beyond the motion, three per side of the set, padded
    std::vector<RigidMotion> m_motion;    // by the impulses since load(), per component
    // velocities and motions after the last sweep, three per side of the set and six per component
    std::vector<double> m_swept;
    std::array<std::vector<double>, kMixed> m_sweptDelta;
};

}  // namespace bullet_fem
