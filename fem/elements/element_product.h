// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_pass.h"

namespace bullet_fem
{

/// The elements' part of A p. With H = sum_b (p_b - p_0) g'_b^T, per corner
///   f_a = (lambda' tr(H) I + mu' (H + H^T) + H sigma') g'_a.
template <class Real>
struct ElementProduct
{
    const ElementBlocks<Real>* m_elements;
    const WarpedBlock<Real>* m_warped;
    double m_stiffnessFactor;  ///< of K' in A, h^2 + h beta [s2]
    const PaddedVec3* m_p;     ///< of every node; differences are taken in double, then rounded to Real
    CornerBlock<Real>* m_out;  ///< out: f_a, to be summed by sumCorners()
};

/// Runs the product over blocks, on the widest vectors that the processor has. Any division into ranges gives the same
/// bits. Never allocates; safe on distinct blocks at the same time.
template <class Real>
void runElementProduct(const ElementProduct<Real>& product, Range blocks);

/// The same in plain C++: what the kernel is tested against.
namespace reference
{
template <class Real>
void runElementProduct(const ElementProduct<Real>& product, Range blocks);
}

}  // namespace bullet_fem
