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

/// Element pass for elements of general C: that of their lambda and mu, plus the positive semidefinite D =
/// ElementBlocks::m_stiffness. The energy is V eps : C eps / 2 with eps = S - I, F = R S. For a change dF, H = R^T dF,
/// the frame rotates by Omega and S changes by
///     dS = sym(H - Omega S),     Omega S + S Omega = H - H^T   <=>   (tr(S) I - S) omega = axl(H - H^T)
/// and the adjoint of this map gives forces from stresses: with the skew W for which (rest + W) S is symmetric,
///     f_a = -R (stress + rest + W) g_a,
///     stress = V (2 mu E + lambda tr(E) I),   E = eps + damping sym(rate),
///     rest = V D (eps + damping dS(rate)) + V sigma_0
/// so that no element has a torque (withInitialStress()). `stress` has the axes of the strain, and needs no W.
template <class Real>
struct OrthotropicPass
{
    ElementPass<Real> m_elements;  ///< m_warped is not written
    StretchBlock<Real>* m_warped;  ///< out, one per block
};

/// Element product for general C, with H = R^T sum over b of (p_b - p_0) g_b^T and W from `rest`:
///     stress = factor V (mu (H + H^T) + lambda tr(H) I),   rest = factor V D dS(H),
///     f_a = R (stress + rest + W + H T) g_a.
/// For S = I, dS(H) = sym(H) and W = 0, as for Hooke's law, which uses sym(H) at any S: the omitted term is negative in
/// compression, and T in tension. Stiff fibres, however, also resist the rotation of a strained element; bodies
/// strained by half whose A omits this gain energy without bound.
template <class Real>
struct OrthotropicProduct
{
    ElementProduct<Real> m_elements;     ///< m_warped is not read
    const StretchBlock<Real>* m_warped;  ///< output of the pass
};

/// Run over ranges of blocks, on the widest vectors that the processor has. Bitwise independent of the division into
/// ranges. Never allocate; thread-safe on distinct ranges.
template <class Real>
void runOrthotropicPass(const OrthotropicPass<Real>& pass, Range blocks);
template <class Real>
void runOrthotropicProduct(const OrthotropicProduct<Real>& product, Range blocks);

}  // namespace bullet_fem
