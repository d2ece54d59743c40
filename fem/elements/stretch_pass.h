// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_product.h"

namespace bullet_fem
{

/// Data of kLanes elements whose stress does not have the axes of their strain for products with K' during a step, in
/// their own frames.
template <class Real>
struct alignas(64) StretchBlock
{
    Real m_rotation[9][kLanes];  ///< R, row-major
    Real m_tension[6][kLanes];   ///< tension factor times V sigma+: xx, yy, zz, yz, xz, xy
    Real m_stretch[6][kLanes];   ///< S = R^T F in this order
    Real m_spin[6][kLanes];      ///< (tr(S) I - S)^-1 in this order; 0 where it is nearly singular (kMinPivot)
};

/// Element pass over such elements.
template <class Real>
struct StretchPass
{
    ElementPass<Real> m_elements;  ///< m_warped is not written
    StretchBlock<Real>* m_warped;  ///< out, one per block
};

/// Element product after such a pass.
template <class Real>
struct StretchProduct
{
    ElementProduct<Real> m_elements;     ///< m_warped is not read
    const StretchBlock<Real>* m_warped;  ///< output of the pass
};

}  // namespace bullet_fem
