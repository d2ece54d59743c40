// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/factor/fill_order.h"

namespace bullet_fem
{

/// Consecutive node columns of the factor that share the rows below them, so that both are dense blocks.
struct Supernode
{
    int m_first, m_columns;  ///< the columns m_first ... m_first + m_columns - 1, in elimination order; m_columns >= 1
    int m_rowStart, m_rows;  ///< the rows below the columns: m_rows >= 0 entries of SupernodeTree::m_row, ascending
    int m_parent;            ///< a later supernode; its columns and rows contain the rows below. -1 at a root
};

/// Where the entries of the factor are, in nodes of 3x3 blocks, before any of them is computed. The rows of a supernode
/// are columns or rows of its parent; children come before parents, and a supernode's descendants are the ones just
/// before it (postorder).
struct SupernodeTree
{
    std::vector<Supernode> m_supernodes;
    std::vector<int> m_row;
    long m_entries = 0;   ///< scalars of all M_s and of the lower halves of all S_s, zeros of merging included
    int m_nodeCount = 0;  ///< columns of all supernodes

    int widestColumns() const;  ///< largest m_columns [nodes]; 0 if there is none
    int longestRows() const;    ///< largest m_rows [nodes]; 0 if there is none
};

/// The supernodes of the factor of `pattern` (one entry a node block, diagonal included) in the elimination order
/// `order`, whose entry k is the row of the pattern that comes k-th. Children are merged into parents where that makes
/// the triangular solves faster, at the price of a few stored zeros, and very wide supernodes are cut into chains.
/// `order` is permuted to suit (the fill stays the same): on return its entry k belongs to column k of the tree. Throws
/// std::invalid_argument if `order` is not a permutation of the pattern's rows.
SupernodeTree buildSupernodeTree(const SparsePattern& pattern, std::vector<int>& order);

/// Blocks of the factor in that elimination order, the diagonal's included, before any merging. Throws likewise.
long blocksOfFactor(const SparsePattern& pattern, const std::vector<int>& order);

}  // namespace bullet_fem
