// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/laws/law.h"

namespace bullet_fem
{

/// Ogden's law for rubber [Ogden 1972] of three terms, with the principal stretches lambda_i:
///
///     W = sum over p of mu_p / alpha_p (sum over i of lambda_i^alpha_p - 3) - sum_p mu_p ln J + lambda gamma(J)
///
/// with gamma of VolumeFunction. Its shear modulus at rest is mu = 1/2 sum mu_p alpha_p; lambda = 2 mu nu / (1 - 2 nu).
/// One term of alpha = 2 is the Neo-Hookean law (neo_hooke.h), whose bounds of the tangent hold with mu_p in place of
/// mu. Below a stretch of kMinStretch each term goes on as a parabola.
Law ogdenLaw();

}  // namespace bullet_fem
