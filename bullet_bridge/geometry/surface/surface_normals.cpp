// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/surface_normals.h"

#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr double kFlatSurfaceCosine = 0.99;  // smallest cosine of normals that count as one

double angleBetween(const Vec3& a, const Vec3& b)
{
    return std::atan2(norm(cross(a, b)), dot(a, b));
}

}  // namespace

Vec3 edgeNormal(const SoftSurface& surface, int edge)
{
    Vec3 sum;
    surface.topology().visitTrianglesOf(edge, [&](int t) { sum += surface.faceNormal(t); });
    return unit(sum);
}

Vec3 nodeNormal(const SoftSurface& surface, int node)
{
    const std::vector<Vec3>& x = surface.position();
    Vec3 sum;
    for (int t : surface.topology().trianglesAt(node))
    {
        const Triangle& nodes = surface.topology().triangles()[t];
        const int at = nodes[0] == node ? 0 : nodes[1] == node ? 1 : 2;
        const Vec3 next = x[nodes[(at + 1) % 3]] - x[node], last = x[nodes[(at + 2) % 3]] - x[node];
        sum += angleBetween(next, last) * surface.faceNormal(t);
    }
    return unit(sum);
}

Vec3 normalAt(const SoftSurface& surface, int triangle, const TrianglePoint& point)
{
    switch (point.m_feature)
    {
        case TriangleFeature::edge:
            return edgeNormal(surface, surface.topology().edgesOf(triangle)[point.m_number]);
        case TriangleFeature::corner:
            return nodeNormal(surface, surface.topology().triangles()[triangle][point.m_number]);
        default:
            return surface.faceNormal(triangle);
    }
}

Vec3 intoFace(const SoftSurface& surface, int edge, int triangle)
{
    const auto [a, b] = surface.topology().edges()[edge];
    const Triangle& t = surface.topology().triangles()[triangle];
    const std::vector<Vec3>& x = surface.position();
    const int opposite = t[0] + t[1] + t[2] - a - b;
    const Vec3 e = unit(x[b] - x[a]), r = x[opposite] - x[a];
    return unit(r - dot(r, e) * e);
}

std::array<Vec3, 2> intoFaces(const SoftSurface& surface, int edge)
{
    const auto [first, second] = surface.topology().trianglesOf(edge);
    return {intoFace(surface, edge, first), intoFace(surface, edge, second)};
}

bool isFlatEdge(const SoftSurface& surface, int edge)
{
    const Vec3 normal = edgeNormal(surface, edge);
    bool flat = true;
    surface.topology().visitTrianglesOf(
        edge, [&](int t) { flat = flat && !(dot(surface.faceNormal(t), normal) < kFlatSurfaceCosine); });
    return flat;
}

bool isFlatNode(const SoftSurface& surface, int node)
{
    const Vec3 normal = nodeNormal(surface, node);
    const TriangleRange around = surface.topology().trianglesAt(node);
    return std::none_of(around.begin(), around.end(),
                        [&](int t) { return dot(surface.faceNormal(t), normal) < kFlatSurfaceCosine; });
}

double minAlongEdges(const SoftSurface& surface, int node, const Vec3& direction)
{
    const std::vector<Vec3>& x = surface.position();
    double least = 1;
    for (int t : surface.topology().trianglesAt(node))
        for (int corner : surface.topology().triangles()[t])
            if (corner != node) least = std::min(least, dot(direction, unit(x[corner] - x[node])));
    return least;
}

Vec3 middleOf(const SoftSurface& surface)
{
    const VectorBounds& bounds = surface.tree().bounds().m_start;
    return 0.5 * (bounds.m_low + bounds.m_high);
}

}  // namespace bullet_fem
