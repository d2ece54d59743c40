// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/geometry/surface/beyond_plane.h"
#include "bullet_bridge/geometry/surface/ridge_lanes.h"

namespace bullet_fem
{

/// The ridges of a surface that are near another one, beside each other in memory and four in a vector: most pairs of
/// them are ruled out before anything else of the surfaces is read. Grows, never shrinks.
class NearRidges
{
public:
    struct Item
    {
        SurfaceRidges::Ridge m_ridge;
        int m_leaf;       ///< node of the tree
        CoarseBox m_box;  ///< swept over SurfaceRidges::kSteps steps
    };

    /// Some that follow each other in the tree.
    struct Run
    {
        CoarseBox m_box;  ///< around theirs
        int m_first, m_end;
    };

    /// Around the leaves of a surface with ridges that come within a distance [m] of a box within the step.
    static CoarseBox bounds(const SoftSurface& surface, const CoarseBox& box, double reach);

    /// Where the other surface is, and what of it is near.
    struct Other
    {
        CoarseBox m_box;      ///< around what may touch
        BeyondPlane m_plane;  ///< all of it lies behind
        double m_near;        ///< distance at the start [m]
        double m_band;        ///< and on the way [m]
    };

    /// The ridges in these leaves, without what stays beyond the plane. Positions are kept relative to `origin`, so
    /// that single precision holds them wherever in the world they are.
    void list(const SoftSurface& surface, const Other& other, const Vec3& origin);

    void clear();

    /// The largest component of a position [m].
    double extent() const { return m_extent; }

    const Item& operator[](int k) const { return m_items[k]; }
    const std::vector<Run>& runs() const { return m_runs; }
    /// Number k is in block k / 4; unused places of the last one meet nothing.
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
