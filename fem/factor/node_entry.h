// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// What a factor holds for two nodes that are joined in it.
enum class NodeEntry
{
    block,  ///< a 3x3 block: the directions act on each other
    number  ///< one number for all three directions: a ninth of the memory
};

/// Rows and columns of a node in panels of that kind.
inline int rowsOfNode(NodeEntry entry)
{
    return entry == NodeEntry::block ? 3 : 1;
}

}  // namespace bullet_fem
