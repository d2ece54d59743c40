// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <Eigen/Sparse>

#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

/// K of a shape with accurate bending, from its energy alone: the sums of (lambda + 2/3 mu) V theta^2 / 2 over patches,
/// of mu |dev(s_k)|^2 times the smoothed volume over edge domains, and of mu (1 - b) V |dev(eps_e)|^2 over elements.
/// Unknown 3 i + c is component c of node i.
Eigen::SparseMatrix<double> smoothedStiffness(const RestShape& shape);

}  // namespace bullet_fem
