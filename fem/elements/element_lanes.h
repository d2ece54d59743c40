// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

constexpr int kLanes = 16;  ///< elements of a block: one AVX-512 vector of floats, two of AVX2, four of SSE or NEON

/// Up to kLanes patches side by side: lane k of each of the blocks holds elements of patch k alone, so that sums over
/// patches are sums of vectors.
struct PatchGroup
{
    int m_firstBlock, m_blocks;  ///< at most ElementPatches::kMost blocks
};

/// Where the elements of a shape stand in blocks of kLanes. Without patches in the mesh's order, and what fills the
/// last block are copies of the last element. With patches, the largest come first, and what their columns lack are
/// copies of elements. Copies have no stiffness, and no node knows them. Const after construction.
struct ElementLanes
{
    explicit ElementLanes(const RestShape& shape);

    int blockCount() const { return static_cast<int>(m_element.size()) / kLanes; }
    bool isCopy(int lane) const { return m_lane[m_element[lane]] != lane; }

    std::vector<int> m_lane;           ///< of every element
    std::vector<int> m_element;        ///< of every lane: its own, or the one that it has a copy of
    std::vector<int> m_order;          ///< elements in the order in which nodes sum what they get from them
    std::vector<PatchGroup> m_groups;  ///< none without patches
};

}  // namespace bullet_fem
