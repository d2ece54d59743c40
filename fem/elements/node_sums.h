// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// out_i = given_i + the sum of the corner contributions at node i, in double and in a fixed order; given_i is scale_i
/// p_i, or out_i itself without a scale.
template <class Real>
struct NodeSums
{
    const NodeCorners* m_nodes;
    const CornerBlock<Real>* m_corners;
    const double* m_scale;  ///< one per node, or null: adds to m_out
    const PaddedVec3* m_p;  ///< one per node; unused without a scale
    Vec3* m_out;            ///< one per node
};

/// Sums over a range of nodes. Bitwise independent of the division into ranges. Never allocates; thread-safe on
/// distinct nodes.
template <class Real>
void sumCorners(const NodeSums<Real>& sums, Range nodes);

}  // namespace bullet_fem
