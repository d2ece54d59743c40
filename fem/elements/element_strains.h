// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_pass.h"

namespace bullet_fem
{

/// Strains of kLanes elements in their own frames, sym(R^T F) - I [-]: xx, yy, zz, yz, xz, xy, shears not doubled.
template <class Real>
struct alignas(64) StrainBlock
{
    Real m_entry[6][kLanes];
};

/// Strains and rotations of all elements at the present positions. F - R is computed in double and R as in an
/// ElementPass. Positions must be finite.
template <class Real>
struct ElementStrains
{
    const ElementBlocks<Real>* m_elements;
    const PaddedVec3* m_x;        ///< per node [m]
    Quaternion* m_rotation;       ///< in: initial guess, out: solution; kLanes a block
    StrainBlock<Real>* m_strain;  ///< out, one per block
};

/// Runs over a range of blocks, on the widest vectors that the processor has. Bitwise independent of the division into
/// ranges. Never allocates; thread-safe on distinct blocks.
template <class Real>
void runElementStrains(const ElementStrains<Real>& strains, Range blocks);

/// Reference implementation in plain C++, for tests of the kernel.
namespace reference
{
template <class Real>
void runElementStrains(const ElementStrains<Real>& strains, Range blocks);
}

}  // namespace bullet_fem
