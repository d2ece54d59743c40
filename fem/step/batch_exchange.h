// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "fem/elements/element_blocks.h"
#include "fem/step/batch_width.h"

namespace bullet_fem
{

/// Values of kBodyLanes bodies: in lanes [value][row][body]; in an array of each body [value], or, of more than one
/// row, [block of kLanes values][row][value of the block].
struct LaneLayout
{
    int m_count;     ///< values
    int m_rows = 1;  ///< >= 1
};

/// From kBodyLanes arrays, aligned as their numbers are, to lanes, aligned to 64 bytes; and back, but to arrays that
/// are null. On the widest vectors that the processor has.
void gatherLanes(const float* const* arrays, float* lanes, const LaneLayout& layout);
void gatherLanes(const double* const* arrays, double* lanes, const LaneLayout& layout);
void scatterLanes(float* const* arrays, const float* lanes, const LaneLayout& layout);
void scatterLanes(double* const* arrays, const double* lanes, const LaneLayout& layout);

}  // namespace bullet_fem
