// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// R_i, row-major.
struct NodeRotation
{
    float m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
};

/// R_i of every node from the rotations of the elements around it: the normalised sum of V_e q_e, signs turned
/// to the first one's where they differ. Where the rotations are far apart (|sum| below 0.7 of sum V_e) it is polar(sum
/// V_e R_e) instead. Of nodes without elements: the identity.
struct NodeRotations
{
    const NodeCorners* m_nodes;
    const Quaternion* m_rotation;  ///< of the elements
    NodeRotation* m_out;           ///< one a node
};

/// Runs over nodes. Any division into ranges gives the same bits. Never allocates; safe on distinct nodes at the same
/// time.
void averageRotations(const NodeRotations& rotations, Range nodes);

/// sum of V_e R_e over the elements of some blocks [m3]. The body's one rotation is Q = polarRotation(the sum over all
/// blocks, its last Q).
Mat3 sumRotations(const NodeCorners& nodes, const Quaternion* rotation, Range blocks);

/// The same in plain C++: what the kernels are tested against.
namespace reference
{
void averageRotations(const NodeRotations& rotations, Range nodes);
Mat3 sumRotations(const NodeCorners& nodes, const Quaternion* rotation, Range blocks);
}  // namespace reference

}  // namespace bullet_fem
