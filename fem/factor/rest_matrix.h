// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "fem/factor/block_matrix.h"

namespace bullet_fem
{

/// The lower half of a symmetric block matrix over the nodes of a factor, in the factor's order and in single
/// precision, for iterations with a factor of another matrix. Constant once built.
struct RestMatrix
{
    RestMatrix() = default;

    /// Row k is node order[k] of A; `position` is a node's row, or -1 for nodes to leave out. Allocates.
    RestMatrix(const BlockMatrix& A, const std::vector<int>& order, const std::vector<int>& position);

    int nodeCount() const { return static_cast<int>(m_rowStart.size()) - 1; }
    std::size_t byteCount() const;

    std::vector<int> m_rowStart = {0};  ///< start of each row, then the end
    std::vector<int> m_column;          ///< ascending; the last entry of a row is the diagonal
    std::vector<float> m_values;        ///< nine per block, row-major
};

}  // namespace bullet_fem
