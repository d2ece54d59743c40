// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <vector>

#include "fem/factor/block_matrix.h"
#include "fem/factor/node_entry.h"
#include "fem/factor/supernode_tree.h"

namespace bullet_fem
{

/// Receives one supernode of nc columns and nr rows below [nodes]: S = (L11 L11^T)^-1, k nc x k nc, both halves filled,
/// and M = L21 L11^-1, k nr x k nc, k = rowsOfNode(); both column-major without gaps, valid during the call only.
using SupernodeTaker = std::function<void(int supernode, const double* S, const double* M)>;

/// Factors the positive definite A = L L^T, children before parents (multifrontal method), and passes each supernode to
/// `take` in the form that solves A x = b without scalar recursion:
///     up the tree:    b_below -= M b_columns
///     each supernode: b_columns = S b_columns
///     down the tree:  b_columns -= M^T b_below
/// With NodeEntry::number it factors the matrix of a third of each block's trace.
/// Column k of the tree is node order[k] of A; nodes of A that are not in `order` are not in the factor. Throws
/// std::runtime_error naming the node of A if A is not positive definite or not finite, std::invalid_argument if A,
/// `order` and the tree are inconsistent, and std::bad_alloc.
void factorSupernodes(const BlockMatrix& A, const std::vector<int>& order, const SupernodeTree& tree,
                      const SupernodeTaker& take, NodeEntry entry = NodeEntry::block);

}  // namespace bullet_fem
