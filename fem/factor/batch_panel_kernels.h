// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

/// forwardPanel() and backwardPanel() for kPanelLanes right-hand sides, interleaved as in forwardPanelLanes(). Each
/// result is bitwise equal to that of the single right-hand side, so the summation order differs from
/// forwardPanelLanes(), at a small cost. `scratch` has batchScratchOf(panel) entries. Uses the widest vectors that the
/// processor has.
void forwardPanelBatch(const Panel& panel, float* y, float* scratch);
void backwardPanelBatch(const Panel& panel, float* y, float* scratch);

/// Scratch entries: the rows, and partial sums of the columns of a chunk, of all right-hand sides.
inline std::size_t batchScratchOf(const Panel& panel)
{
    const std::size_t rows = panel.m_rowsBelow + panel.m_columns, parts = kPanelColumns * kPanelLanes / 2;
    return kPanelLanes * (rows + parts);
}

}  // namespace bullet_fem
