// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/factor/fill_order.h"

namespace bullet_fem
{

/// Consecutive node columns of the factor with equal rows below them, so that both parts are dense blocks.
struct Supernode
{
    int m_first, m_columns;  ///< the columns m_first ... m_first + m_columns - 1, in elimination order; m_columns >= 1
    int m_rowStart, m_rows;  ///< the rows below the columns: m_rows >= 0 entries of SupernodeTree::m_row, ascending
    int m_parent;            ///< a later supernode, whose columns and rows contain the rows below; -1 at a root
};

/// The sparsity structure of the factor, in nodes of 3x3 blocks, computed before its numbers. The rows of a supernode
/// are columns or rows of its parent; children precede parents, and a supernode's descendants directly precede it
/// (postorder).
struct SupernodeTree
{
    std::vector<Supernode> m_supernodes;
    std::vector<int> m_row;
    long m_entries = 0;   ///< scalars of all M_s and of the lower halves of all S_s, explicit zeros of merging included
    int m_nodeCount = 0;  ///< number of columns of all supernodes

    int widestColumns() const;  ///< maximum m_columns [nodes]; 0 without supernodes
    int longestRows() const;    ///< maximum m_rows [nodes]; 0 without supernodes
};

/// The supernodes of the factor of `pattern` (one entry per node block, diagonal included) in the elimination order
/// `order`, whose entry k is the row of the pattern eliminated k-th. Merges children into parents where that makes the
/// triangular solves faster, at the price of a few stored zeros, and cuts very wide supernodes into chains. Permutes
/// `order` accordingly (the fill is unchanged): on return its entry k belongs to column k of the tree. Throws
/// std::invalid_argument if `order` is not a permutation of the pattern's rows.
SupernodeTree buildSupernodeTree(const SparsePattern& pattern, std::vector<int>& order);

/// Number of blocks of the factor in the elimination order, diagonal included, before any merging. Throws
/// std::invalid_argument if `order` is not a permutation of the pattern's rows.
long blocksOfFactor(const SparsePattern& pattern, const std::vector<int>& order);

}  // namespace bullet_fem
