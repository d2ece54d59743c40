// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/near_ridges.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{

CoarseBox NearRidges::bounds(const SoftSurface& surface, const CoarseBox& box, double reach)
{
    const SurfaceTree& tree = surface.tree();
    CoarseBox bounds = CoarseBox::empty();
    tree.visitNearLeaves(box, reach, surface.ridges().has(), [&](int leaf) { bounds.add(tree.box(leaf)); });
    return bounds;
}

void NearRidges::list(const SoftSurface& surface, const Other& other, const Vec3& origin)
{
    clear();
    const SurfaceTree& tree = surface.tree();
    const SurfaceRidges& ridges = surface.ridges();
    const std::vector<Vec3>&x = surface.position(), &change = surface.change();
    const auto listLeaf = [&](int leaf)
    {
        const SurfaceTree::Leaf places = tree.leaf(leaf);
        for (const auto *at = ridges.begin(places), *end = ridges.end(places); at != end; ++at)
        {
            const auto [edge, a, b] = *at;
            if (other.m_plane.isBeyond(x[a], change[a], x[b], change[b], other.m_near, other.m_band)) continue;
            add({*at, leaf, SurfaceRidges::boxOf(*at, tree)}, x[a] - origin, x[b] - x[a]);
        }
    };
    tree.visitNearLeaves(other.m_box, other.m_near, ridges.has(), listLeaf);
}

void NearRidges::clear()
{
    m_items.clear();
    m_blocks.clear();
    m_runs.clear();
    m_extent = 0;
}

void NearRidges::add(const Item& item, const Vec3& start, const Vec3& along)
{
    const int number = static_cast<int>(m_items.size());
    if (number % RidgeLanes::kCount == 0) m_blocks.push_back(RidgeLanes::empty());
    if (number % kRun == 0) m_runs.push_back({CoarseBox::empty(), number, number});
    m_items.push_back(item);
    m_blocks.back().set(number % RidgeLanes::kCount, item.m_box, start, along);
    m_runs.back().m_box.add(item.m_box);
    m_runs.back().m_end = number + 1;
    m_extent = std::max({m_extent, std::fabs(start.x), std::fabs(start.y), std::fabs(start.z)});
}

}  // namespace bullet_fem
