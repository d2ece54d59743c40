// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/deep_pair_search.h"

#include <algorithm>
#include <limits>

#include "bullet_bridge/geometry/surface/coarse_box.h"

namespace bullet_fem
{
namespace
{

constexpr double kAnyDistance = std::numeric_limits<double>::infinity();

bool encloses(const SoftSurface& surface, const Vec3& point)
{
    if (surface.tree().bounds().m_start.squaredDistance(point) > 0) return false;
    TrianglePoint nearest;
    const int triangle = surface.tree().nearestTriangle(
        point, kAnyDistance, [](int) { return false; }, nearest);
    return triangle >= 0 && dot(point - nearest.m_point, normalAt(surface, triangle, nearest)) < 0;
}

}  // namespace

bool areDeepInside(const SoftSurface& a, const SoftSurface& b)
{
    if (!a.topology().isClosed() || !b.topology().isClosed()) return false;
    const Vec3 ofA = middleOf(a), ofB = middleOf(b);
    return (encloses(b, ofA) && encloses(a, ofA)) || (encloses(a, ofB) && encloses(b, ofB));
}

Vec3 wayApart(const SoftSurface& from, const SoftSurface& to)
{
    const Vec3 way = middleOf(to) - middleOf(from);
    return norm(way) > 0 ? unit(way) : Vec3{1, 0, 0};
}

void findAlong(const SoftSurface& nodes, const SoftSurface& faces, const Vec3& way,
               std::vector<SurfaceContact>& touches)
{
    const double farthest = faces.size() + norm(middleOf(nodes) - middleOf(faces)) + nodes.size();
    for (int i : nodes.topology().vertices())
    {
        const Vec3& x = nodes.position()[i];
        if (faces.tree().bounds().m_start.squaredDistance(x) > 0) continue;
        SurfaceContact first;
        double least = kAnyDistance, cosine = 0;
        const auto cross = [&](int t)
        {
            const Corners corners = faces.tree().corners(t);
            const double along = dot(faces.faceNormal(t), way);
            const double distance = dot(faces.faceNormal(t), corners[0] - x) / along;
            std::array<double, 3> weights;
            if (along == 0 || !(distance > 0 && distance < least)) return;
            if (!projectOnPlane(corners, x + distance * way, weights)) return;
            if (!(std::min({weights[0], weights[1], weights[2]}) >= 0)) return;
            least = distance;
            cosine = along;
            first = {{i, i, i}, faces.topology().triangles()[t], {1, 0, 0}, weights, way, -distance, i, t};
        };
        faces.tree().visitNear(CoarseBox::of(x, farthest * way), 0, cross);
        if (cosine > 0) touches.push_back(first);  // otherwise the ray enters: the node is outside
    }
}

}  // namespace bullet_fem
