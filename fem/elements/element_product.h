// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_pass.h"

namespace bullet_fem
{

/// The elements' part of A p: with H = sum_b (p_b - p_0) g'_b^T, per corner
///   f_a = (lambda' tr(H) I + mu' (H + H^T) + H sigma') g'_a.
/// With m_tangent, l C' (C' : H) and a patch's part replace lambda' tr(H) I (TangentBlock).
/// In patches, the V-weighted mean of tr(H) over the patch replaces tr(H), in the diagonal of H, too.
template <class Real>
struct ElementProduct
{
    const ElementBlocks<Real>* m_elements;
    const WarpedBlock<Real>* m_warped;
    double m_stiffnessFactor;                       ///< coefficient of K' in A, c h^2 + h beta [s2]
    const PaddedVec3* m_p;                          ///< per node; differences are taken in double, then rounded to Real
    CornerBlock<Real>* m_out;                       ///< out: f_a, to be summed by sumCorners()
    const TangentBlock<Real>* m_tangent = nullptr;  ///< one per block, from an ElementPass; null for none
};

/// Runs the product over work units (ElementBlocks::workUnitCount()), on the widest vectors that the processor has.
/// Bitwise independent of the division into ranges. Never allocates; thread-safe on distinct work units.
template <class Real>
void runElementProduct(const ElementProduct<Real>& product, Range pieces);

}  // namespace bullet_fem
