// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/factor/dense_kernels.h"
#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

/// The kernels of factors in plain C++: what those for vectors are tested against.
namespace reference
{

/// One pivot after the other.
int eliminatePivots(const DenseFront& front, double& pivotValue);
void subtractProduct(const DenseProduct& product);

/// For `lanes` interleaved right-hand sides.
void forwardPanel(const Panel& panel, float* y, int lanes);
void backwardPanel(const Panel& panel, float* y, int lanes);
void forwardIsotropic(const Panel& panel, float* y, int lanes);
void backwardIsotropic(const Panel& panel, float* y, int lanes);

}  // namespace reference
}  // namespace bullet_fem
