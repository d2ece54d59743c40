// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The force by which a fixed node is held.
struct NodeReaction
{
    int m_node = 0;  ///< in [0, n)
    Vec3 m_point;    ///< where it acts: the middle of the node's way in the step [m]
    Vec3 m_force;    ///< on the body, in the world's axes: impulse over h, the mean of the step [N]
};

}  // namespace bullet_fem
