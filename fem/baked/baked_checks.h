// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/baked/baked_header.h"
#include "fem/factor/supernode_tree.h"

namespace bullet_fem
{

// A checksum excludes accidental damage; these checks exclude every other invalid value, so that nothing out of bounds
// is read or written. All throw std::invalid_argument that names the value.

/// The supernodes, checked to be a postordered tree of the free nodes in which a supernode's rows are columns or rows
/// of its parent.
SupernodeTree checkedTree(const BakedHeader& header, const BakedArrays& arrays);

/// The position of every node in the order, -1 for fixed ones. The order must contain each free node once.
std::vector<int> checkedPositions(const BakedArrays& arrays);

/// Checks that numbers are finite and in their ranges, flags 0 or 1, and embedded vertices and triangles within bounds.
/// Values that TetMesh or RestShape check are left to them.
void checkValues(const BakedHeader& header, const BakedArrays& arrays);

/// Checks the rows of A0 of the low-memory path: lower halves, ascending, each with its diagonal at the end.
void checkRestMatrix(const BakedHeader& header, const BakedArrays& arrays);

/// Checks that all numbers of the factor are finite.
void checkPanels(const float* panels, std::size_t count);

}  // namespace bullet_fem
