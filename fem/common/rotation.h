// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The rotation R of the polar decomposition F = R S that is nearest to F: R^T R = I, det R = +1, also where F is flat,
/// inverted or zero. R maximises tr(R^T F). `guess` must be a rotation; near the answer it saves most of the work, and
/// where F leaves R undetermined (F of rank one or zero) the answer stays as near to it as rounding allows. Where
/// the square of F is not finite, it is the guess.
BULLETFEM_API Mat3 polarRotation(const Mat3& F, const Mat3& guess);

}  // namespace bullet_fem
