// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/geometry/surface/beyond_plane.h"
#include "bullet_bridge/geometry/surface/ridge_lanes.h"

namespace bullet_fem
{

/// The ridges of a surface that are near another surface, contiguous in memory, four per SIMD vector: most pairs are
/// rejected without access to the surfaces. Grows, never shrinks.
class NearRidges
{
public:
    /// A ridge with its bounding box.
    struct Item
    {
        SurfaceRidges::Ridge m_ridge;
        int m_leaf;       ///< node of the surface's tree
        CoarseBox m_box;  ///< swept over SurfaceRidges::kSteps steps
    };

    /// Consecutive ridges with a common bounding box.
    struct Run
    {
        CoarseBox m_box;  ///< bounding box of their boxes
        int m_first, m_end;
    };

    /// Bounding box of the leaves with ridges that come within `reach` [m] of a box within the step.
    static CoarseBox bounds(const SoftSurface& surface, const CoarseBox& box, double reach);

    /// The other surface as input of the search.
    struct Other
    {
        CoarseBox m_box;      ///< bounding box of its part that may be in contact
        BeyondPlane m_plane;  ///< a plane that it lies behind
        double m_near;        ///< search distance at the start [m]
        double m_band;        ///< search distance during the motion [m]
    };

    /// Lists the ridges near `other` that do not stay beyond its plane. Positions are stored relative to `origin`, so
    /// that single precision suffices anywhere in the world.
    void list(const SoftSurface& surface, const Other& other, const Vec3& origin);

    void clear();

    /// Largest component of a stored position [m].
    double extent() const { return m_extent; }

    const Item& operator[](int k) const { return m_items[k]; }
    const std::vector<Run>& runs() const { return m_runs; }
    /// The block of ridge k, which is lane k % 4 of it. Unused lanes of the last block meet nothing.
    const RidgeLanes& block(int k) const { return m_blocks[k]; }

private:
    static constexpr int kRun = 8;

    void add(const Item& item, const Vec3& start, const Vec3& along);

    std::vector<Item> m_items;
    std::vector<RidgeLanes> m_blocks;
    std::vector<Run> m_runs;
    double m_extent = 0;
};

}  // namespace bullet_fem
