// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/baked/baked_header.h"
#include "fem/factor/supernode_tree.h"

namespace bullet_fem
{

// A checksum keeps out accidents; these keep out the rest: whatever numbers a file holds, nothing is read or written
// outside of what there is. All throw std::invalid_argument that names the value.

/// The supernodes, if they are a postordered tree of the free nodes in which a supernode's rows are columns or rows of
/// its parent.
SupernodeTree checkedTree(const BakedHeader& header, const BakedArrays& arrays);

/// Where every node stands in the order; -1 for fixed ones. The order must hold each of the others once.
std::vector<int> checkedPositions(const BakedArrays& arrays);

/// Finite numbers in their ranges, flags that are 0 or 1, and embedded vertices and triangles that there are. What a
/// TetMesh or a RestShape checks is left to them.
void checkValues(const BakedHeader& header, const BakedArrays& arrays);

/// The rows of A0 in the low-memory path: lower halves, ascending, each with its diagonal at the end.
void checkRestMatrix(const BakedHeader& header, const BakedArrays& arrays);

/// All numbers of the factor are finite.
void checkPanels(const float* panels, std::size_t count);

}  // namespace bullet_fem
