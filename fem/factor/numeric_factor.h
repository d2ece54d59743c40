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
/// and M = L21 L11^-1, k nr x k nc, k = rowsOfNode(); both column by column without gaps. They are gone when the call
/// returns.
using SupernodeTaker = std::function<void(int supernode, const double* S, const double* M)>;

/// Factors the positive definite A = L L^T, children before parents, and hands each supernode to `take` as the blocks
/// that solve A x = b without any scalar recursion:
///     up the tree:    b_below -= M b_columns
///     each supernode: b_columns = S b_columns
///     down the tree:  b_columns -= M^T b_below
/// NodeEntry::number factors the matrix that has a third of each block's trace instead of the block.
/// Column k of the tree is node order[k] of A; nodes of A that `order` leaves out are left out of the factor. Throws
/// std::runtime_error that names the node of A if A is not positive definite or not finite, std::invalid_argument if
/// A, `order` and the tree do not fit together, and std::bad_alloc.
void factorSupernodes(const BlockMatrix& A, const std::vector<int>& order, const SupernodeTree& tree,
                      const SupernodeTaker& take, NodeEntry entry = NodeEntry::block);

}  // namespace bullet_fem
