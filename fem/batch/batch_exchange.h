// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "fem/body/batch_width.h"
#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// Values of kBatchWidth bodies: in lanes [value][row][body]; in an array of each body [value], or, of more than one
/// row, [block of kLanes values][row][value of the block].
struct BatchLayout
{
    int m_count;     ///< values
    int m_rows = 1;  ///< >= 1
};

/// From kBatchWidth arrays, aligned as their numbers are, to lanes, aligned to 64 bytes; and back, but to arrays that
/// are null. On the widest vectors that the processor has.
void gatherBatch(const float* const* arrays, float* lanes, const BatchLayout& layout);
void gatherBatch(const double* const* arrays, double* lanes, const BatchLayout& layout);
void scatterBatch(float* const* arrays, const float* lanes, const BatchLayout& layout);
void scatterBatch(double* const* arrays, const double* lanes, const BatchLayout& layout);

}  // namespace bullet_fem
