// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bullet_fem/fem/common/quaternion.h"
#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/common/chunks.h"
#include "fem/elements/element_lanes.h"

namespace bullet_fem
{

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

/// Of a block's elements in the volumes of their patches [-].
template <class Real>
struct alignas(64) PatchShares
{
    Real m_lane[kLanes];
};

/// Of a block's elements: 1 where the law is Neo-Hookean, 0 where it is Hooke's.
template <class Real>
struct alignas(64) LawLanes
{
    Real m_lane[kLanes];
};

constexpr int kStiffnessEntries = 21;  ///< of a symmetric C

/// Of a block's elements V times what C has besides lambda and mu, the upper triangle row by row [J].
template <class Real>
struct alignas(64) StiffnessBlock
{
    Real m_entry[kStiffnessEntries][kLanes];
};

/// The elements of a RestShape in blocks, as ElementLanes puts them. Real: float or double. Const after construction.
template <class Real>
struct ElementBlocks
{
    explicit ElementBlocks(const RestShape& shape) : ElementBlocks(shape, ElementLanes(shape)) {}
    ElementBlocks(const RestShape& shape, const ElementLanes& lanes);

    int blockCount() const { return static_cast<int>(m_blocks.size()); }
    bool hasPatches() const { return !m_groups.empty(); }
    /// Of what kernels divide into ranges: blocks, or groups of blocks where there are patches.
    int pieceCount() const { return hasPatches() ? static_cast<int>(m_groups.size()) : blockCount(); }
    /// Pieces that have as many blocks as kBlocksPerChunk, or more.
    int piecesPerChunk() const;

    std::vector<ElementBlock<Real>> m_blocks;
    std::vector<PatchGroup> m_groups;               ///< none without patches
    std::vector<LawLanes<Real>> m_law;              ///< one a block; none where all elements have Hooke's law
    std::vector<PatchShares<Real>> m_share;         ///< likewise; a block: of every element in its patch's volume [-]
    std::vector<StiffnessBlock<Real>> m_stiffness;  ///< likewise where an element is orthotropic; of all elements
};

/// Which corners a node gathers from. Const after construction.
struct NodeCorners
{
    explicit NodeCorners(const RestShape& shape) : NodeCorners(shape, ElementLanes(shape)) {}
    NodeCorners(const RestShape& shape, const ElementLanes& lanes);
    int nodeCount() const { return static_cast<int>(m_start.size()) - 1; }

    std::vector<int> m_start;     ///< of every node and of the end, into m_corner
    std::vector<int> m_corner;    ///< places in an array of CornerBlock taken as vectors; in ElementLanes::m_order
    std::vector<float> m_volume;  ///< V_e of every lane's element, 0 of copies [m3]
    std::vector<float> m_volumeAround;         ///< of every node's elements together [m3]
    std::vector<std::array<int, 4>> m_parity;  ///< of every lane's corners: 1 where it is the second, fourth ... of
                                               ///< its node, 0 else

    /// The lane of a corner, and the place of one (of the element in lane e, its local node a).
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
