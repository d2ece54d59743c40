// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/laws/law.h"
#include "fem/laws/volume_ratio.h"

namespace bullet_fem
{

/// Ciarlet's Neo-Hookean law [Ciarlet 1988, 4.10], with I = tr(F^T F), J = det F:
///
///     W = mu/2 (I - 3) + g(J),   g = lambda/4 (J^2 - 1) - (lambda/2 + mu) ln J
///
/// which equals Hooke's law of equal E and nu at small strain. Below J0 = kMinVolumeRatio g continues as the
/// parabola with equal value, slope and curvature at J0: flattening an element takes about 10 E.
///
/// With F = R S, B = R S R^T = I + e and C = adj(B), the stress R dW/dF^T R^T and the approximation of its derivative
/// in A are
///
///     tau = mu B + g' C = mu (2 e - tr(e) I - adj(e)) + q C,   q = g' + mu
///     dtau = l C (C : H) + k mu (H + H^T) + H T,               H = dF R^T
///
/// The expression for tau has no cancellation at small strain. The exact derivative is mu H + g'' C (C : H) + g' D,
/// with D bilinear in B and H. k = max(1, (mu + |g'| s) / (2 mu)), with s = 1 + tr(e) / 3 + sqrt(2/3) |dev(e)| >= every
/// stretch, and l = max(0, g'' - 3 mu i^2 / |C|^2), with i = (tr(C)^2 / |C|^2 - 1) / 2, which is 1 if all stretches are
/// equal, bound the contribution of D, and equal 1 and lambda at rest. T is the tension of an ElementPass.
/// In a patch of mean dilatation lambda is 0, and the patch's pressure p is added to q and g'.
LawResponse neoHooke(const Mat3& e, double lambda, double mu, double pressure = 0);

/// The traits of the law.
Law neoHookeLaw();

}  // namespace bullet_fem
