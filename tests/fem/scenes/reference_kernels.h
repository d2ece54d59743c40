// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/factor/dense_kernels.h"
#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

/// The factor's kernels in plain C++: the reference for vectorised ones.
namespace reference
{

/// Eliminates one pivot after another.
int eliminatePivots(const DenseFront& front, double& pivotValue);
void subtractProduct(const DenseProduct& product);

/// For `lanes` interleaved right-hand sides.
void forwardPanel(const Panel& panel, float* y, int lanes);
void backwardPanel(const Panel& panel, float* y, int lanes);
void forwardIsotropic(const Panel& panel, float* y, int lanes);
void backwardIsotropic(const Panel& panel, float* y, int lanes);

}  // namespace reference
}  // namespace bullet_fem
