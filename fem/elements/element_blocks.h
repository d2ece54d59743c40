// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bullet_fem/fem/common/quaternion.h"
#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/common/chunks.h"
#include "fem/common/lane_count.h"
#include "fem/laws/law.h"

namespace bullet_fem
{

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

/// A node's position or velocity, padded so that element kernels load it as one vector.
struct alignas(32) PaddedVec3
{
    double x = 0, y = 0, z = 0, zero = 0;
};

/// The rest data of kLanes elements side by side, as in RestElement.
template <class Real>
struct alignas(64) ElementBlock
{
    double m_Dm[9][kLanes];          ///< row-major: columns X_1 - X_0, X_2 - X_0, X_3 - X_0 [m]
    Real m_DmInverse[9][kLanes];     ///< row-major: g_1, g_2, g_3 [1/m]
    Real m_lambdaVolume[kLanes];     ///< [J]
    Real m_muVolume[kLanes];         ///< [J]
    std::int32_t m_node[kLanes][4];  ///< node indices of every element
};

/// A vector for each corner of a block's elements: the contributions to the nodes.
template <class Real>
struct alignas(64) CornerBlock
{
    Real m_vector[4][kLanes][4];  ///< corner, element, (x, y, z, 0)
};

/// Volumes of a block's elements over those of their patches [-].
template <class Real>
struct alignas(64) PatchShares
{
    Real m_lane[kLanes];
};

/// How the kernels evaluate the law of a lane's element.
enum class LaneLaw
{
    linear,          ///< Hooke's law
    neoHooke,        ///< in lanes
    single,          ///< by SingleResponses; lambda multiplies a function of the volume ratio
    singleAllAtOnce  ///< by SingleResponses, lambda included
};

/// LaneLaw of a block's elements, as numbers.
template <class Real>
struct alignas(64) LawLanes
{
    Real m_lane[kLanes];
};

/// A lane whose law is evaluated one element at a time (SingleResponses).
struct SingleLane
{
    const Law* m_law = nullptr;  ///< null: the lane has another law, or is a copy
    double m_volume = 1;         ///< [m3]
    double m_mu = 0;             ///< [Pa]
    double m_size = 0;           ///< cube root of the volume [m]
    std::size_t m_history = 0;   ///< index of the element's first history variable
    std::array<double, kMaxLawConstants> m_constants = {};
};

constexpr int kStiffnessEntries = 21;  ///< number of independent entries of a symmetric C

/// V times C minus its part of lambda and mu, for a block's elements, the upper triangle row by row [J].
template <class Real>
struct alignas(64) StiffnessBlock
{
    Real m_entry[kStiffnessEntries][kLanes];
};

/// H or H^2 of kLanes patches (AssumedStrain), as AssumedStrain::m_filter has H.
template <class Real>
struct alignas(64) FilterLanes
{
    Real m_entry[AssumedStrain::kEntries][kLanes];
};

/// The elements of a RestShape in blocks, ordered by ElementLanes. Real: float or double. Constant after construction.
template <class Real>
struct ElementBlocks
{
    explicit ElementBlocks(const RestShape& shape) : ElementBlocks(shape, ElementLanes(shape)) {}
    ElementBlocks(const RestShape& shape, const ElementLanes& lanes);

    int blockCount() const { return static_cast<int>(m_blocks.size()); }
    bool hasPatches() const { return !m_groups.empty(); }
    /// True if assumed strains are those of runAssumedPass(), for laws other than Hooke's.
    bool assumesForAnyLaw() const { return !m_filter.empty() && !(m_law.empty() && m_stiffness.empty()); }
    /// Number of work units that kernels divide into ranges: blocks, or groups of blocks with patches.
    int workUnitCount() const { return hasPatches() ? static_cast<int>(m_groups.size()) : blockCount(); }
    /// Number of work units that hold about kBlocksPerChunk blocks, >= 1.
    int workUnitsPerChunk() const;

    std::vector<ElementBlock<Real>> m_blocks;
    std::vector<PatchGroup> m_groups;   ///< empty without patches
    std::vector<LawLanes<Real>> m_law;  ///< one per block; empty if no law varies (LawKind::varying)
    std::vector<SingleLane> m_single;   ///< one per lane; empty if no law is evaluated one element at a time
    /// One a block: share of each element in its patch's volume [-]; empty without patches.
    std::vector<PatchShares<Real>> m_share;
    /// One per group of patches: H^2 of bodies of Hooke's law alone, else H; empty without assumed strains.
    std::vector<FilterLanes<Real>> m_filter;
    /// One a block; empty if no element is orthotropic, else of all elements.
    std::vector<StiffnessBlock<Real>> m_stiffness;

private:
    void takeFilters(const RestShape& shape, const ElementLanes& lanes);
};

/// The corners that each node gathers from. Constant after construction.
struct NodeCorners
{
    explicit NodeCorners(const RestShape& shape) : NodeCorners(shape, ElementLanes(shape)) {}
    NodeCorners(const RestShape& shape, const ElementLanes& lanes);
    int nodeCount() const { return static_cast<int>(m_start.size()) - 1; }

    std::vector<int> m_start;  ///< start of each node in m_corner, then the end
    /// Indices into an array of CornerBlock taken as vectors; ordered by ElementLanes::m_order.
    std::vector<int> m_corner;
    std::vector<float> m_volume;        ///< V_e of every lane's element; 0 for copies [m3]
    std::vector<float> m_volumeAround;  ///< sum of V_e around every node [m3]
    /// Per lane and corner: 1 if it is the second, fourth ... of its node, else 0.
    std::vector<std::array<int, 4>> m_parity;

    /// The lane of a corner; the corner of local node a of the element in lane e.
    static int element(int corner)
    {
        const unsigned c = static_cast<unsigned>(corner);
        return static_cast<int>(c / (4 * kLanes) * kLanes + c % kLanes);
    }
    static int corner(int e, int a) { return (e / kLanes * 4 + a) * kLanes + e % kLanes; }
};

/// Number of blocks for this many elements; arrays of Quaternion have kLanes entries per block.
constexpr int blockCount(int elements)
{
    return (elements + kLanes - 1) / kLanes;
}

}  // namespace bullet_fem
