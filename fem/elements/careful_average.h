// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/node_rotations.h"

namespace bullet_fem
{

/// Squared length of the plain sum of V_e q_e around a node below which carefulAverage() is to look at it [m6].
inline float leastSquaredLength(const NodeCorners& nodes, int node)
{
    constexpr float kAlignedShare = 0.98f;
    const float least = kAlignedShare * nodes.m_volumeAround[node];
    return least * least;
}

/// R_i of one node, in plain double precision and with all cares: signs turned to the first element's; polar(sum V_e
/// R_e), as near to the first one's rotation as the sum leaves open, where the rotations are far apart.
NodeRotation carefulAverage(const NodeRotations& rotations, int node);

}  // namespace bullet_fem
