// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// Rotation R_i of a node, row-major.
struct NodeRotation
{
    float m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
};

/// R_i of every node from the rotations of its elements: the normalised sum of V_e q_e, with signs aligned with the
/// first. If the rotations are far apart (|sum| below 0.7 of sum V_e), polar(sum V_e R_e) instead. Identity at nodes
/// without elements.
struct NodeRotations
{
    const NodeCorners* m_nodes;
    const Quaternion* m_rotation;  ///< rotations of the elements
    NodeRotation* m_out;           ///< one per node
};

/// Computes R_i of a range of nodes. Bitwise independent of the division into ranges. Never allocates; thread-safe on
/// distinct nodes.
void averageRotations(const NodeRotations& rotations, Range nodes);

/// Sum of V_e R_e over the elements of a range of blocks [m3]. The body's rotation is polarRotation(sum over all
/// blocks, last Q).
Mat3 sumRotations(const NodeCorners& nodes, const Quaternion* rotation, Range blocks);

}  // namespace bullet_fem
