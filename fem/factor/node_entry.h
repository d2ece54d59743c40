// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// Entry of a factor for a pair of adjacent nodes.
enum class NodeEntry
{
    block,  ///< a 3x3 block, which couples the directions
    number  ///< one number for all three directions: a ninth of the memory
};

/// Rows and columns per node in panels of such entries.
inline int rowsOfNode(NodeEntry entry)
{
    return entry == NodeEntry::block ? 3 : 1;
}

}  // namespace bullet_fem
