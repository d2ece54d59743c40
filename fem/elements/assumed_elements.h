// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/stretch_pass.h"

namespace bullet_fem
{

/// Element pass for assumed strains (AssumedStrain) of any law; bodies of Hooke's law alone have a faster one in
/// ElementPass. The law of element e is evaluated at eps~_e = eps_p + H_p (eps_e - eps_p), and its stress sigma~_e does
/// the work of V_e (sigma_p + H_p (sigma~_e - sigma_p)) on eps_e, with the mean sigma_p over the patch. With the mean
/// Hm over the patch of H = R^T dF, the frame rotates as that of runOrthotropicPass() with S and Hm; W makes the torque
/// of the patch zero. Damping is damping times the product's K'. Of a TangentBlock, m_patchBulk is k; of a patch, the
/// StretchBlock of the first element has all but the tension. Runs over ranges of work units
/// (ElementBlocks::workUnitCount()), on the widest vectors that the processor has. Bitwise independent of the division
/// into ranges. Never allocates; thread-safe on distinct ranges.
template <class Real>
void runAssumedPass(const StretchPass<Real>& pass, Range units);

/// Product with K' after runAssumedPass(), run alike: strains change by sym(H - Hm) + dS(Hm), the stress of element e
/// is l C (C : eps~_e) + 2 k mu eps~_e (LawResponse), or C eps~_e of an anisotropic law; H T is added as in
/// runOrthotropicProduct().
template <class Real>
void runAssumedProduct(const StretchProduct<Real>& product, Range units);

}  // namespace bullet_fem
