// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_bridge/rigid/world_objects.h"

namespace bullet_fem
{

/// What the joints of a step join, and when.
struct JointScene
{
    const std::vector<FemSoftBody*>& m_bodies;   ///< solved together: an index is that of ContactProblem::m_bodies
    const std::vector<FemSoftBody*>& m_outside;  ///< the others of the world
    RigidProxies& m_rigid;
    const WorldObjects& m_world;
    double m_step;       ///< of the world [s]
    RigidPhase m_phase;  ///< that m_rigid was cleared for
};

/// What was found besides joints.
struct JointFlags
{
    bool m_lost = false;  ///< the other end left the world: the anchor or joint was removed from the soft body
    bool m_bad = false;  ///< a node of another body, a soft body that is not FEM, or a value that is no number: ignored
    bool m_outside = false;  ///< a FEM body that is awake but not in this solve is joined: it was taken to stand still

    JointFlags& operator|=(const JointFlags& b)
    {
        m_lost = m_lost || b.m_lost;
        m_bad = m_bad || b.m_bad;
        m_outside = m_outside || b.m_outside;
        return *this;
    }
};

}  // namespace bullet_fem
