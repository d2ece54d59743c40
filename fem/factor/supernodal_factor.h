// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/factor/sparse_cholesky.h"

namespace bullet_fem
{

/// A Cholesky factor packed for the two triangular solves of a preconditioner: columns with the same pattern below them
/// form a supernode, whose entries are one dense single-precision panel. Const after construction.
class SupernodalFactor
{
public:
    SupernodalFactor() = default;
    explicit SupernodalFactor(const SparseLower& L);

    int size() const { return m_size; }
    long entryCount() const { return m_entryCount; }  ///< entries of L, the fill included
    int supernodeCount() const { return static_cast<int>(m_supernodes.size()); }

    /// Rows of scratch that solve() needs.
    int scratchSize() const { return m_maxRows; }

    /// y <- (L L^T)^-1 y for `Lanes` interleaved right-hand sides: y has size() * Lanes entries, scratch has
    /// scratchSize() * Lanes. Instantiated for Lanes = 1 and 4.
    template <int Lanes>
    void solve(float* y, float* scratch) const;

private:
    struct Supernode
    {
        int m_firstColumn, m_columns;
        int m_rowStart, m_rows;    // into m_rowIndex: rows below the diagonal block
        std::size_t m_panelStart;  // into m_panel: inverse diagonals, then columns of the block, then of the rows below
    };

    template <int Lanes>
    void forward(const Supernode& s, float* y, float* scratch) const;
    template <int Lanes>
    void backward(const Supernode& s, float* y, float* scratch) const;

    int m_size = 0, m_maxRows = 0;
    long m_entryCount = 0;
    std::vector<Supernode> m_supernodes;
    std::vector<int> m_rowIndex;
    std::vector<float> m_panel;
};

}  // namespace bullet_fem
