// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/dense_compliance.h"

namespace bullet_fem
{

/// The ends of a body whose impulses change in the sweeps, and their part of its dense compliance, packed: three
/// quarters of the points that are found near a surface carry nothing, and without them a sweep stays in the cache.
/// Grows, never shrinks.
class WorkingSet
{
public:
    /// Forgets all ends, of which the body has so many. W, the compliance of all, may have changed.
    void reset(int ends);

    /// Forgets all ends; W is still the same.
    void clear();

    /// Adds an end of the body, once or again.
    void add(int e);

    /// To be called when all are added, with what all ends of the body have.
    void pack(const DenseCompliance& W, const std::vector<Vec3>& velocity);

    bool has(int e) const { return m_place[e] >= 0; }
    const std::vector<int>& ends() const { return m_ends; }

    /// Of an end of the set [m/s].
    const Vec3& velocity(int e) const { return m_velocity[m_place[e]]; }

    /// Adds an impulse to one; the velocities follow.
    void push(int e, const Vec3& impulse) { m_W.respond(m_place[e], impulse, m_velocity); }

    /// A direction of impulses, and the velocities that it makes, beside the present ones: beginProbe forgets the last,
    /// addToProbe adds an impulse to an end, and followProbe goes `step` times its way.
    void beginProbe();
    void addToProbe(int e, const Vec3& impulse) { m_probeImpulse[m_place[e]] += impulse; }
    void respondToProbe();
    const Vec3& probeImpulse(int e) const { return m_probeImpulse[m_place[e]]; }
    const Vec3& probeVelocity(int e) const { return m_probeVelocity[m_place[e]]; }
    void followProbe(double step);

private:
    std::vector<int> m_ends, m_packedEnds;  // of the body; those that m_W is of
    std::vector<int> m_place;               // of the body's ends in the set, or -1
    DenseCompliance m_W;
    std::vector<Vec3> m_velocity, m_probeImpulse, m_probeVelocity;  // per end of the set
};

}  // namespace bullet_fem
