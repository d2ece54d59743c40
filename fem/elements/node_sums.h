// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// out_i = given_i + sum of what the corners at node i hold, in double and in a fixed order; given_i is scale_i p_i, or
/// out_i itself where there is no scale.
template <class Real>
struct NodeSums
{
    const NodeCorners* m_nodes;
    const CornerBlock<Real>* m_corners;
    const double* m_scale;  ///< one a node, or nullptr: add to what is in m_out
    const PaddedVec3* m_p;  ///< one a node; not read where there is no scale
    Vec3* m_out;            ///< one a node
};

/// Sums over nodes. Any division into ranges gives the same bits. Never allocates; safe on distinct nodes at the same
/// time.
template <class Real>
void sumCorners(const NodeSums<Real>& sums, Range nodes);

/// The same in plain C++: what the kernel is tested against.
namespace reference
{
template <class Real>
void sumCorners(const NodeSums<Real>& sums, Range nodes);
}

}  // namespace bullet_fem
