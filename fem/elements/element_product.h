// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_pass.h"

namespace bullet_fem
{

/// The elements' part of A p. With H = sum_b (p_b - p_0) g'_b^T, per corner
///   f_a = (lambda' tr(H) I + mu' (H + H^T) + H sigma') g'_a.
/// With m_cofactor, C' (C' : H) stands in place of lambda' tr(H) I.
/// Where elements make patches, tr(H) is the mean over the element's patch, weighted by V, in the diagonal of H, too.
template <class Real>
struct ElementProduct
{
    const ElementBlocks<Real>* m_elements;
    const WarpedBlock<Real>* m_warped;
    double m_stiffnessFactor;  ///< of K' in A, h^2 + h beta [s2]
    const PaddedVec3* m_p;     ///< of every node; differences are taken in double, then rounded to Real
    CornerBlock<Real>* m_out;  ///< out: f_a, to be summed by sumCorners()
    const StressBlock<Real>* m_cofactor = nullptr;  ///< C', one a block, as an ElementPass left them; null for none
};

/// Runs the product over pieces (see ElementBlocks::pieceCount()), on the widest vectors that the processor has. Any
/// division into ranges gives the same bits. Never allocates; safe on distinct pieces at the same time.
template <class Real>
void runElementProduct(const ElementProduct<Real>& product, Range pieces);

/// The same in plain C++: what the kernel is tested against.
namespace reference
{
template <class Real>
void runElementProduct(const ElementProduct<Real>& product, Range pieces);
}

}  // namespace bullet_fem
