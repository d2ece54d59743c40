// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Ciarlet's Neo-Hookean law [Ciarlet 1988, 4.10], with I = tr(F^T F), J = det F:
///
///     W = mu/2 (I - 3) + g(J),   g = lambda/4 (J^2 - 1) - (lambda/2 + mu) ln J
///
/// which at small strain is Hooke's with the same E and nu. Below J0 = kLeastVolumeRatio g goes on as the parabola that
/// has its value, slope and curvature there, so that it is defined for flat and inverted elements, too, and drives them
/// back: stress and tangent are continuous, and to press an element flat takes some 10 E.
///
/// With F = R S, B = R S R^T = I + e and C = adj(B), the stress R dW/dF^T R^T and what stands for its derivative in A
/// are
///
///     tau = mu B + g' C = mu (2 e - tr(e) I - adj(e)) + q C,   q = g' + mu
///     dtau = l C (C : H) + k mu (H + H^T) + H T,               H = dF R^T
///
/// The first has no differences of large numbers at small strain. The exact derivative is mu H + g'' C (C : H) + g' D,
/// with D bilinear in B and H; k = max(1, (mu + |g'| s) / (2 mu)), s = 1 + tr(e) / 3 + sqrt(2/3) |dev(e)| >= every
/// stretch, and l = max(0, g'' - 3 mu i^2 / |C|^2) with i = (tr(C)^2 / |C|^2 - 1) / 2, 1 where
/// all stretches are equal, cover what D adds, and are 1 and lambda at rest. T is the tension of an ElementPass.
constexpr double kLeastVolumeRatio = 0.1;

/// What the law makes of one element: in the units of lambda and mu.
struct NeoHookeResponse
{
    Mat3 m_stress;        ///< tau
    Mat3 m_cofactor;      ///< C
    double m_bulk = 0;    ///< l
    double m_shear = 1;   ///< k [-]
    double m_energy = 0;  ///< W
};

/// Of a symmetric e.
NeoHookeResponse neoHooke(const Mat3& e, double lambda, double mu);

}  // namespace bullet_fem
