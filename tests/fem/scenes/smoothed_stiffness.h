// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <Eigen/Sparse>

#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

/// K of a shape that bends accurately, from its energy alone: the patches' sum of (lambda + 2/3 mu) V theta^2 / 2, and
/// mu |dev(s_k)|^2 times its smoothed volume of every edge domain and mu (1 - b) V |dev(eps_e)|^2 of every element.
/// Unknown 3 i + c is component c of node i.
Eigen::SparseMatrix<double> smoothedStiffness(const RestShape& shape);

}  // namespace bullet_fem
