// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_bridge/rigid/world_objects.h"

namespace bullet_fem
{

/// The bodies and objects that the joints of a step may connect.
struct JointScene
{
    const std::vector<FemSoftBody*>& m_bodies;   ///< solved together, indexed as in ContactProblem::m_bodies
    const std::vector<FemSoftBody*>& m_outside;  ///< the other FEM bodies of the world
    RigidProxies& m_rigid;
    const WorldObjects& m_world;
    double m_step;  ///< time step of the world [s]
};

/// Flags from collecting joints.
struct JointFlags
{
    bool m_lost = false;  ///< the other side left the world: the anchor or joint was removed from the soft body
    bool m_bad = false;   ///< a node of another body, a soft body that is not FEM, or a value that is not finite: the
                          ///< joint was ignored
    bool m_outside = false;  ///< joint to an active FEM body outside of this solve, which was taken to be at rest

    JointFlags& operator|=(const JointFlags& b)
    {
        m_lost = m_lost || b.m_lost;
        m_bad = m_bad || b.m_bad;
        m_outside = m_outside || b.m_outside;
        return *this;
    }
};

}  // namespace bullet_fem
