// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/factor/block_matrix.h"

namespace bullet_fem
{

/// The lower half of a symmetric matrix, compressed by columns; row indices ascend.
struct LowerMatrix
{
    int m_size = 0;
    std::vector<int> m_columnStart;  ///< m_size + 1 entries
    std::vector<int> m_row;
    std::vector<double> m_value;
};

/// The scalar entries of A's blocks: node order[k] of A has the rows and columns 3 k ... 3 k + 2. Nodes missing in
/// `order` are left out.
LowerMatrix lowerMatrix(const BlockMatrix& A, const std::vector<int>& order);

}  // namespace bullet_fem
