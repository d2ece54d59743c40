// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/factor/supernode_tree.h"

namespace bullet_fem
{

/// A supernode and all its descendants, which directly precede it.
struct Subtree
{
    int m_begin, m_end;  ///< supernodes m_begin ... m_end - 1, the last one the root
    int m_firstAbove;    ///< its rows above have the indices m_firstAbove, m_firstAbove + 1, ... in m_forwardRow
};

/// A supernode tree divided into subtrees that can be solved concurrently, and the top that joins them. A subtree's
/// forward solve accumulates its contributions to rows of the top in rows of its own, which are added to the top
/// subtree by subtree, so that the tree fixes the order of all sums. Small trees are all top.
struct TreeDivision
{
    /// Divides the tree, whose nodes are numbered 0 ... m_nodeCount - 1. Allocates.
    explicit TreeDivision(const SupernodeTree& tree);

    std::vector<Subtree> m_subtrees;  ///< ascending
    std::vector<int> m_top;           ///< the other supernodes, ascending
    std::vector<int> m_forwardRow;    ///< SupernodeTree::m_row with the subtrees' own rows, from m_nodeCount on
    int m_rowCount = 0;               ///< m_nodeCount plus the subtrees' own rows
};

}  // namespace bullet_fem
