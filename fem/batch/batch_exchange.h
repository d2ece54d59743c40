// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "fem/body/batch_width.h"
#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// Layout of values of kBatchWidth bodies: [value][row][body] in lanes; in each body's own array [value], or, with more
/// than one row, [block of kLanes values][row][value in the block].
struct BatchLayout
{
    int m_count;     ///< values
    int m_rows = 1;  ///< >= 1
};

/// Copies from kBatchWidth arrays, aligned to their number type, to lanes, aligned to 64 bytes (gather), or back,
/// except to null arrays (scatter). Uses the widest vectors that the processor has.
void gatherBatch(const float* const* arrays, float* lanes, const BatchLayout& layout);
void gatherBatch(const double* const* arrays, double* lanes, const BatchLayout& layout);
void scatterBatch(float* const* arrays, const float* lanes, const BatchLayout& layout);
void scatterBatch(double* const* arrays, const double* lanes, const BatchLayout& layout);

}  // namespace bullet_fem
