// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <Eigen/Sparse>

#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

/// The rest stiffness of a shape; unknown 3 i + c is component c of node i.
Eigen::SparseMatrix<double> sparseStiffness(const RestShape& shape);

}  // namespace bullet_fem
