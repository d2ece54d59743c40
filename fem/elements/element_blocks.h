// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bullet_fem/fem/common/quaternion.h"
#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/common/chunks.h"

namespace bullet_fem
{

constexpr int kLanes = 16;  ///< elements of a block: one AVX-512 vector of floats, two of AVX2, four of SSE or NEON

/// A node's position or velocity as the element kernels load it, in one piece.
struct alignas(32) PaddedVec3
{
    double x = 0, y = 0, z = 0, zero = 0;
};

/// kLanes elements side by side, what a RestElement knows of each.
template <class Real>
struct alignas(64) ElementBlock
{
    double m_Dm[9][kLanes];          ///< row-major: columns X_1 - X_0, X_2 - X_0, X_3 - X_0 [m]
    Real m_DmInverse[9][kLanes];     ///< row-major: g_1, g_2, g_3 [1/m]
    Real m_lambdaVolume[kLanes];     ///< [J]
    Real m_muVolume[kLanes];         ///< [J]
    std::int32_t m_node[kLanes][4];  ///< of every element
};

/// A vector for each of the corners of a block's elements: what they hand to the nodes.
template <class Real>
struct alignas(64) CornerBlock
{
    Real m_vector[4][kLanes][4];  ///< corner, element, (x, y, z, 0)
};

/// The elements of a RestShape in blocks, in the mesh's order. The last block is filled up with copies of the last
/// element that have no stiffness and that no node knows. Real: float or double. Const after construction.
template <class Real>
struct ElementBlocks
{
    explicit ElementBlocks(const RestShape& shape);
    int blockCount() const { return static_cast<int>(m_blocks.size()); }

    std::vector<ElementBlock<Real>> m_blocks;
};

/// Which corners a node gathers from. Const after construction.
struct NodeCorners
{
    explicit NodeCorners(const RestShape& shape);
    int nodeCount() const { return static_cast<int>(m_start.size()) - 1; }

    std::vector<int> m_start;           ///< of every node and of the end, into m_corner
    std::vector<int> m_corner;          ///< places in an array of CornerBlock taken as vectors; elements ascending
    std::vector<float> m_volume;        ///< V_e of every element, 0 in what fills the last block [m3]
    std::vector<float> m_volumeAround;  ///< of every node's elements together [m3]
    std::vector<std::array<int, 4>> m_parity;  ///< of every element's corners: 1 where it is the second, fourth ... of
                                               ///< its node, 0 else

    /// The element and the place of a corner (of element e, its local node a).
    static int element(int corner)
    {
        const unsigned c = static_cast<unsigned>(corner);
        return static_cast<int>(c / (4 * kLanes) * kLanes + c % kLanes);
    }
    static int corner(int e, int a) { return (e / kLanes * 4 + a) * kLanes + e % kLanes; }
};

/// Blocks that hold this many elements; arrays of Quaternion have kLanes entries for each.
constexpr int blockCount(int elements)
{
    return (elements + kLanes - 1) / kLanes;
}

}  // namespace bullet_fem
