// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_pass.h"

namespace bullet_fem
{

/// The strains of kLanes elements in their own frames, sym(R^T F) - I [-]: xx, yy, zz, yz, xz, xy, shears not doubled.
template <class Real>
struct alignas(64) StrainBlock
{
    Real m_entry[6][kLanes];
};

/// Strains and rotations of all elements where nodes are now. F - R is taken in double and R found as in an
/// ElementPass. Positions must be finite.
template <class Real>
struct ElementStrains
{
    const ElementBlocks<Real>* m_elements;
    const PaddedVec3* m_x;        ///< of every node [m]
    Quaternion* m_rotation;       ///< in: where to start from, out: found; kLanes a block
    StrainBlock<Real>* m_strain;  ///< out, one a block
};

/// Of a range of blocks, on the widest vectors that the processor has. Any division into ranges gives the same bits.
/// Never allocates; safe on distinct blocks at the same time.
template <class Real>
void runElementStrains(const ElementStrains<Real>& strains, Range blocks);

/// The same in plain C++: what the kernel is tested against.
namespace reference
{
template <class Real>
void runElementStrains(const ElementStrains<Real>& strains, Range blocks);
}

}  // namespace bullet_fem
