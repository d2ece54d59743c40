// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/rigid/impact_patches.h"

namespace bullet_fem
{

/// The rigid motions of both sides of a patch as the step begins.
struct ImpactMotions
{
    RigidProxy m_first, m_second;

    double approachAt(const Impact& impact) const
    {
        return dot(impact.m_normal, m_second.velocityAt(impact.m_point) - m_first.velocityAt(impact.m_point));
    }
};

ImpactMotions motionsOf(const ImpactScene& scene, const ImpactPatch& patch);

/// A proxy that cannot move, with a velocity [m/s].
RigidProxy immovableProxy(const Vec3& velocity);

/// An impact of a patch with what the step tells: its sides, and if it is pressed, its point, normal and impulse.
Impact impactAt(const ImpactScene& scene, const ImpactPatch& patch);

/// Finds the supports of both sides, which then count as immovable, the velocity before the impact and the energy.
void beginImpact(const ImpactScene& scene, const ImpactPatch& patch, ImpactMotions motions, Impact& impact);

}  // namespace bullet_fem
