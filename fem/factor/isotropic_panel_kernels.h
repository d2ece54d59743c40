// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

constexpr int kIsotropicColumns = 4;  ///< columns of a chunk of an isotropic panel; the last chunk has 1 to 4

/// The steps of a solve with an isotropic panel, which has one row and one column a node, applied to each of the node's
/// three directions: Panel's m_columns and m_rowsBelow count nodes, and a chunk has kIsotropicColumns columns. y has 3
/// entries per node, or 3 x 16 interleaved. `scratch` has 48 blocks() entries (times 16), aligned to 64 bytes. Uses the
/// widest vectors that the processor has.
void forwardIsotropic(const Panel& panel, float* y, float* scratch);
void backwardIsotropic(const Panel& panel, float* y, float* scratch);
void forwardIsotropicLanes(const Panel& panel, float* y, float* scratch);
void backwardIsotropicLanes(const Panel& panel, float* y, float* scratch);

}  // namespace bullet_fem
