// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/stretch_pass.h"

namespace bullet_fem
{

/// Element pass for elements of general C: that of their lambda and mu, plus the positive semidefinite D =
/// ElementBlocks::m_stiffness. The energy is V eps : C eps / 2 with eps = S - I, F = R S. For a change dF, H = R^T dF,
/// the frame rotates by Omega and S changes by
///     dS = sym(H - Omega S),     Omega S + S Omega = H - H^T   <=>   (tr(S) I - S) omega = axl(H - H^T)
/// and the adjoint of this map gives forces from stresses: with the skew W for which (rest + W) S is symmetric,
///     f_a = -R (stress + rest + W) g_a,
///     stress = V (2 mu E + lambda tr(E) I),   E = eps + damping sym(rate),
///     rest = V D (eps + damping dS(rate)) + V sigma_0
/// so that no element has a torque (withInitialStress()). `stress` has the axes of the strain, and needs no W. Runs
/// over ranges of blocks, on the widest vectors that the processor has. Bitwise independent of the division into
/// ranges. Never allocates; thread-safe on distinct ranges.
template <class Real>
void runOrthotropicPass(const StretchPass<Real>& pass, Range blocks);

/// Element product for general C, run alike, with H = R^T sum over b of (p_b - p_0) g_b^T and W from `rest`:
///     stress = factor V (mu (H + H^T) + lambda tr(H) I),   rest = factor V D dS(H),
///     f_a = R (stress + rest + W + H T) g_a.
/// For S = I, dS(H) = sym(H) and W = 0, as for Hooke's law, which uses sym(H) at any S: the omitted term is negative in
/// compression, and T in tension. Stiff fibres, however, also resist the rotation of a strained element; bodies
/// strained by half whose A omits this gain energy without bound.
template <class Real>
void runOrthotropicProduct(const StretchProduct<Real>& product, Range blocks);

}  // namespace bullet_fem
