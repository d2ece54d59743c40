// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

/// F of element e at positions x [m].
Mat3 deformationGradient(const RestShape& shape, int e, const std::vector<Vec3>& x);

/// Rotation of the frame that the strain of element e is measured in at positions x: polar rotation of its F, with
/// assumed strains of the mean F of its patch. `guess`: a rotation near it.
Mat3 frameRotation(const RestShape& shape, int e, const std::vector<Vec3>& x, const Mat3& guess);

}  // namespace bullet_fem
