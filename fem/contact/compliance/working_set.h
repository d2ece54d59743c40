// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "fem/contact/compliance/point_compliance.h"

namespace bullet_fem
{

/// The sides of a body whose impulses change in the sweeps, the velocities of their slots, and the dense compliance
/// between these: three quarters of the candidate points carry no impulse, and without them a sweep stays in the cache.
/// Sides of overlapping bodies outnumber the nodes that they share. The set changes often and by little: a slot keeps
/// its position, and one that leaves is kept, with correct velocity, until many sides have left. Grows, never shrinks.
class WorkingSet
{
public:
    /// Removes all sides.
    void clear();
    /// Removes all sides, for this compliance with numbered slots, which may have changed and must outlive the set, and
    /// its number of components.
    void reset(const PointCompliance& points, int components);

    /// Begins another choice of sides: add() each, repetitions allowed, then pack(), with the slot values of the
    /// compliance.
    void choose();
    void add(int e);
    void pack(const std::vector<double>& slotVelocity);

    /// Sets all velocities anew.
    void load(const std::vector<double>& slotVelocity);

    /// True for the sides of the last choice, and some that have left.
    bool has(int e) const { return m_place[e] >= 0; }
    const std::vector<int>& ends() const { return m_ends; }

    /// Velocity of a side of the set [m/s].
    Vec3 velocity(int e) const { return read(e, m_velocity, m_motion); }

    /// Adds an impulse to a side of the set; the velocities follow.
    void push(int e, const Vec3& impulse)
    {
        respond(e, impulse, m_velocity);
        pushRigid(e, impulse, m_motion);
    }

    /// Adds the elastic response of the set's slots to an impulse on a side, order() values, or the rigid one of its
    /// component; velocity of a side with such values and motions. maxOrder() is order() with all sides.
    void respond(int e, const Vec3& impulse, std::vector<double>& values) const;
    void pushRigid(int e, const Vec3& impulse, std::vector<RigidMotion>& motions) const
    {
        const RigidSide& rigid = m_sides[m_place[e]].m_rigid;
        if (rigid.component() >= 0) motions[rigid.component()] += rigid.response(impulse);
    }
    Vec3 read(int e, const std::vector<double>& values, const std::vector<RigidMotion>& motions) const
    {
        const Side& side = m_sides[m_place[e]];
        Vec3 v;
        for (int t = side.m_first; t < side.m_end; ++t)
        {
            const double* value = &values[3 * static_cast<std::size_t>(m_terms[t].m_place)];
            v += m_terms[t].m_weight * Vec3{value[0], value[1], value[2]};
        }
        return side.m_rigid.component() >= 0 ? v + side.m_rigid.velocity(motions[side.m_rigid.component()]) : v;
    }
    std::size_t components() const { return m_motion.size(); }
    std::size_t order() const { return padded(3 * m_slots.size(), kResponsePadding); }
    std::size_t maxOrder() const { return m_velocity.size(); }

    /// For AndersonAcceleration: the velocities after the last sweep, and their differences from those of earlier
    /// sweeps; noteSweep stores the difference of this sweep in a slot, and the first sweep has none. mixSweeps
    /// subtracts multiples of them.
    static constexpr int kMixed = 2;
    void noteSweep(int slot, bool first);
    void mixSweeps(const std::array<double, kMixed>& shares);

private:
    // A slot's place in the set, and its weight at a side.
    struct Term
    {
        int m_place;
        double m_weight;
    };

    // A side: its terms m_terms[m_first ... m_end).
    struct Side
    {
        int m_first, m_end;
        RigidSide m_rigid;
    };

    // Calls visit(value, k) for all velocities and motions.
    template <class Visit>
    void forEachValue(const Visit& visit)
    {
        std::size_t k = 0;
        for (; k < 3 * m_slots.size(); ++k) visit(m_velocity[k], k);
        for (RigidMotion& motion : m_motion)
            for (Vec3* part : {&motion.m_linear, &motion.m_angular})
                for (int i = 0; i < 3; ++i) visit((*part)[i], k++);
    }
    void findTerms(int e);
    void packSlot(const std::vector<double>& slotVelocity);
    std::size_t wantedStride(std::size_t slots) const;
    void widen();
    void dropThoseThatLeft();
    void keepSlots(std::size_t count);

    const PointCompliance* m_points = nullptr;
    std::vector<int> m_ends;              // sides of the body
    std::vector<int> m_place;             // index of each of the body's sides in m_ends, or -1
    std::vector<unsigned char> m_wanted;  // per side of the set: in the last choice
    std::vector<Side> m_sides;            // per side of the set, since pack()
    std::vector<Term> m_terms;            // of all sides
    std::vector<int> m_slots;             // slots of the compliance
    std::vector<int> m_placeOfSlot;       // index of each of the compliance's slots in m_slots, or -1
    std::vector<unsigned char> m_isKept;  // scratch, per slot of the set
    std::size_t m_packed = 0;             // number of slots in m_W
    std::size_t m_stride = 0;             // stride of its columns
    std::vector<float> m_W;               // three columns per slot, with room for all slots of the compliance
    std::vector<double> m_velocity;       // beyond the motion, three per slot of the set, padded
    std::vector<RigidMotion> m_motion;    // by the impulses since load(), per component
    // velocities and motions after the last sweep, three per slot of the set and six per component
    std::vector<double> m_swept;
    std::array<std::vector<double>, kMixed> m_sweptDelta;
};

}  // namespace bullet_fem
