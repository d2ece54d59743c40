// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The rotation R of the polar decomposition F = R S: R^T R = I, det R = +1, also if F is flat, inverted or zero. R
/// maximises tr(R^T F). `guess` is the warm start and must be a rotation; near the solution it saves most of the work.
/// If F does not determine R (rank one or zero), R stays as close to the guess as rounding allows. Returns the guess if
/// the square of F is not finite.
BULLETFEM_API Mat3 polarRotation(const Mat3& F, const Mat3& guess);

/// The rotation by a vector w [rad], exp([w]x) [Rodrigues 1840].
BULLETFEM_API Mat3 exponential(const Vec3& w);

}  // namespace bullet_fem
