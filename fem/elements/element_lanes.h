// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

constexpr int kLanes = 16;  ///< elements in a block: one AVX-512 vector of floats, two of AVX2, four of SSE or NEON

/// Up to kLanes patches side by side: lane k of each block holds elements of patch k only, so that sums over patches
/// are sums of vectors.
struct PatchGroup
{
    int m_firstBlock, m_blocks;  ///< at most ElementPatches::kMax blocks
};

/// The order of a shape's elements in blocks of kLanes. Without patches it is the mesh's order, and copies of the last
/// element pad the last block. With patches the largest come first, and copies of elements pad shorter columns. Copies
/// have no stiffness, and no node refers to them. Constant after construction.
struct ElementLanes
{
    explicit ElementLanes(const RestShape& shape);

    int blockCount() const { return static_cast<int>(m_element.size()) / kLanes; }
    bool isCopy(int lane) const { return m_lane[m_element[lane]] != lane; }

    std::vector<int> m_lane;           ///< lane of every element
    std::vector<int> m_element;        ///< element of every lane; for padding the one it copies
    std::vector<int> m_order;          ///< elements in the order in which nodes sum their contributions
    std::vector<PatchGroup> m_groups;  ///< empty without patches
};

}  // namespace bullet_fem
