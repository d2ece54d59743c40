// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/soft_surface.h"

#include <cmath>

#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{
namespace
{

// An edge of more than two faces is never a ridge; an edge of the boundary is neither ridge nor groove.
double bendOf(const SoftSurface& surface, int edge)
{
    const auto [first, second] = surface.topology().trianglesOf(edge);
    if (!surface.topology().isManifold(edge)) return first == second ? 0 : 1;
    return dot(surface.faceNormal(first), intoFace(surface, edge, second));
}

}  // namespace

RestSurface boundaryOf(const TetMesh& mesh)
{
    return {mesh.restPositions(), mesh.surface(), mesh.meanEdgeLength(), std::cbrt(mesh.volume()), {}};
}

SoftSurface::SoftSurface(const RestSurface& rest)
    : m_topology(rest.m_triangles, static_cast<int>(rest.m_positions.size())),
      m_curvature(m_topology, rest.m_positions),
      m_meanEdge(rest.m_meanEdge),
      m_size(rest.m_size),
      m_nearestNode(rest.m_nearestNode),
      m_tree(rest.m_positions, rest.m_triangles),
      m_ridges(m_topology, m_tree),
      m_change(rest.m_positions.size()),
      m_faceNormal(rest.m_triangles.size()),
      m_bend(m_topology.edgeCount()),
      m_preparedEdge(m_topology.edgeCount(), 0)
{
    m_nearNodes.reserve(m_tree.nodeCount());
}

void SoftSurface::place(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h)
{
    m_step = h;
    for (std::size_t i = 0; i < v.size(); ++i) m_change[i] = h * v[i];
    m_tree.refit(x, m_change);
}

void SoftSurface::prepareAll()
{
    for (int t = 0; t < m_topology.triangleCount(); ++t) m_faceNormal[t] = normalOf(m_tree.corners(t));
    std::fill(m_preparedEdge.begin(), m_preparedEdge.end(), static_cast<unsigned char>(1));
    for (int k = 0; k < m_topology.edgeCount(); ++k) m_bend[k] = bendOf(*this, k);
    m_ridges.update(m_tree, m_bend);
}

void SoftSurface::prepareNear(const std::vector<SurfaceTree::Nearby>& boxes)
{
    std::fill(m_faceNormal.begin(), m_faceNormal.end(), std::nullopt);
    std::fill(m_preparedEdge.begin(), m_preparedEdge.end(), static_cast<unsigned char>(0));
    m_nearNodes.clear();
    m_tree.visitNearNodes(boxes, [this](int node) { m_nearNodes.push_back(node); });
    const auto visitTriangles = [this](auto visit)
    {
        for (int node : m_nearNodes)
            if (m_tree.isLeaf(node))
                for (int place = m_tree.leaf(node).m_first; place < m_tree.leaf(node).m_end; ++place)
                    visit(m_tree.triangleAt(place));
    };
    visitTriangles([this](int t) { m_faceNormal[t] = normalOf(m_tree.corners(t)); });
    visitTriangles(
        [this](int t)
        {
            for (int edge : m_topology.edgesOf(t))
            {
                if (m_preparedEdge[edge]) continue;
                m_bend[edge] = bendOf(*this, edge);
                m_preparedEdge[edge] = 1;
            }
        });
    m_ridges.update(m_tree, m_bend, m_nearNodes);
}

double SoftSurface::bend(int edge) const
{
    return m_preparedEdge[edge] ? m_bend[edge] : bendOf(*this, edge);
}

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
        edge, [&](int t) { flat = flat && !(dot(surface.faceNormal(t), normal) < kFlatCosine); });
    return flat;
}

bool isFlatNode(const SoftSurface& surface, int node)
{
    const Vec3 normal = nodeNormal(surface, node);
    const TriangleRange around = surface.topology().trianglesAt(node);
    return std::none_of(around.begin(), around.end(),
                        [&](int t) { return dot(surface.faceNormal(t), normal) < kFlatCosine; });
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
