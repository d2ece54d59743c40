// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "fem/factor/block_matrix.h"

namespace bullet_fem
{

/// The lower half of a symmetric block matrix over the nodes of a factor, in the factor's order and in single
/// precision: what a factor that is not the matrix's own is iterated against. Const once built.
struct RestMatrix
{
    RestMatrix() = default;

    /// Row k is node order[k] of A; position is a node's row, or -1 for what is left out.
    RestMatrix(const BlockMatrix& A, const std::vector<int>& order, const std::vector<int>& position);

    int nodeCount() const { return static_cast<int>(m_rowStart.size()) - 1; }
    std::size_t byteCount() const;

    std::vector<int> m_rowStart = {0};  ///< of every row and of the end
    std::vector<int> m_column;          ///< ascending; the last of a row is the diagonal
    std::vector<float> m_values;        ///< nine of every block, row-major
};

}  // namespace bullet_fem
