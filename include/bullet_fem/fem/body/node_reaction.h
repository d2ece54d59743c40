// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The reaction force at a fixed node.
struct NodeReaction
{
    int m_node = 0;  ///< in [0, n)
    Vec3 m_point;    ///< point of action: the midpoint of the node's motion in the step [m]
    Vec3 m_force;    ///< force on the body in world axes, mean over the step: impulse / h [N]
};

}  // namespace bullet_fem
