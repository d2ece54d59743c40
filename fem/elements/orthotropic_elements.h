// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_product.h"

namespace bullet_fem
{

/// What the product needs of kLanes elements of any C during a step, in their own frames.
template <class Real>
struct alignas(64) OrthotropicBlock
{
    Real m_rotation[9][kLanes];  ///< R, row-major
    Real m_tension[6][kLanes];   ///< tension factor times V sigma+: xx, yy, zz, yz, xz, xy
    Real m_stretch[6][kLanes];   ///< S = R^T F, likewise
    Real m_spin[6][kLanes];      ///< (tr(S) I - S)^-1, likewise; 0 where that is nearly singular (kLeastPivot)
};

/// What an ElementPass is for elements of any C: that of their lambda and mu, and D = ElementBlocks::m_stiffness
/// besides, which is positive semidefinite. Energy is V eps : C eps / 2 with eps = S - I, F = R S. As F changes by dF,
/// H = R^T dF, the frame turns by Omega and S changes by
///     dS = sym(H - Omega S),     Omega S + S Omega = H - H^T   <=>   (tr(S) I - S) omega = axl(H - H^T)
/// and the adjoint of that makes forces of stresses: with the skew W for which (rest + W) S is symmetric,
///     f_a = -R (stress + rest + W) g_a,
///     stress = V (2 mu E + lambda tr(E) I), E = eps + damping sym(rate),   rest = V D (eps + damping dS(rate)) + V
///     sigma_0
/// so that no element has a torque (withInitialStress()). The first stress has the axes of the strain, and needs no W.
template <class Real>
struct OrthotropicPass
{
    ElementPass<Real> m_elements;      ///< m_warped is not written
    OrthotropicBlock<Real>* m_warped;  ///< out, one a block
};

/// What an ElementProduct is, with H = R^T sum over b of (p_b - p_0) g_b^T and W of the rest:
///     stress = factor V (mu (H + H^T) + lambda tr(H) I),   rest = factor V D dS(H),   f_a = R (stress + rest + W + H
///     T) g_a.
/// Where S is I, dS(H) = sym(H) and W = 0, as for Hooke's law. For that sym(H) does at any S: what it leaves out is
/// negative in compression, and in tension it is T. Stiff fibres, however, resist the turn of a strained element, too,
/// and bodies that are strained by half and whose A does not know that gain energy without bound.
template <class Real>
struct OrthotropicProduct
{
    ElementProduct<Real> m_elements;         ///< m_warped is not read
    const OrthotropicBlock<Real>* m_warped;  ///< of the pass
};

/// Both run on the widest vectors that the processor has, over ranges of blocks. Any division into ranges gives the
/// same bits. They never allocate, and are safe on distinct ranges at the same time.
template <class Real>
void runOrthotropicPass(const OrthotropicPass<Real>& pass, Range blocks);
template <class Real>
void runOrthotropicProduct(const OrthotropicProduct<Real>& product, Range blocks);

/// The same in plain C++: what the kernels are tested against.
namespace reference
{
template <class Real>
void runOrthotropicPass(const OrthotropicPass<Real>& pass, Range blocks);
template <class Real>
void runOrthotropicProduct(const OrthotropicProduct<Real>& product, Range blocks);
}  // namespace reference

}  // namespace bullet_fem
