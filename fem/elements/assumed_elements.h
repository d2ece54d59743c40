// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/orthotropic_elements.h"

namespace bullet_fem
{

/// Element pass for assumed strains (AssumedStrain) of any law; bodies of Hooke's law alone have a faster one in
/// ElementPass. The law of element e is evaluated at eps~_e = eps_p + H_p (eps_e - eps_p), and its stress sigma~_e does
/// the work of V_e (sigma_p + H_p (sigma~_e - sigma_p)) on eps_e, with the mean sigma_p over the patch. With the mean
/// Hm over the patch of H = R^T dF, the frame rotates as that of an OrthotropicPass with S and Hm; W makes the torque
/// of the patch zero. Damping is damping times the product's K'.
template <class Real>
struct AssumedPass
{
    ElementPass<Real> m_elements;  ///< m_warped is not written; of a TangentBlock, m_patchBulk is k
    StretchBlock<Real>* m_warped;  ///< out, one per block; all but the tension in that of a patch's first element
};

/// Product with K' of an AssumedPass: strains change by sym(H - Hm) + dS(Hm), the stress of element e is l C (C :
/// eps~_e) + 2 k mu eps~_e (LawResponse), or C eps~_e of an anisotropic law; H T is added as in an OrthotropicProduct.
template <class Real>
struct AssumedProduct
{
    ElementProduct<Real> m_elements;     ///< m_warped is not read
    const StretchBlock<Real>* m_warped;  ///< output of the pass
};

/// Run over ranges of work units (ElementBlocks::workUnitCount()), on the widest vectors that the processor has.
/// Bitwise independent of the division into ranges. Never allocate; thread-safe on distinct ranges.
template <class Real>
void runAssumedPass(const AssumedPass<Real>& pass, Range units);
template <class Real>
void runAssumedProduct(const AssumedProduct<Real>& product, Range units);

}  // namespace bullet_fem
