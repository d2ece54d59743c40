// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/soft_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bullet_fem
{
namespace
{

constexpr double kFlatSurfaceCosine = 0.99;  // smallest cosine of normals that count as one
constexpr double kCreaseCosine = 0.64;       // cosine of 50 degrees: a larger dihedral angle is a crease
constexpr double kRoundShare = 0.1;  // smallest share of a vertex's curvature without creases that makes it round
constexpr double kFewFacets = 0.65;  // change of the normal along an edge with about ten facets around [-]

double angleBetween(const Vec3& a, const Vec3& b)
{
    return std::atan2(norm(cross(a, b)), dot(a, b));
}

}  // namespace

RestSurface boundaryOf(const TetMesh& mesh)
{
    return {mesh.restPositions(),  mesh.surface(),           mesh.surfaceNodes(),
            mesh.meanEdgeLength(), std::cbrt(mesh.volume()), {}};
}

SoftSurface::SoftSurface(const TetMesh& mesh) : SoftSurface(boundaryOf(mesh)) {}

SoftSurface::SoftSurface(const RestSurface& rest)
    : m_triangles(rest.m_triangles),
      m_nodes(rest.m_vertices),
      m_features(rest.m_triangles, static_cast<int>(rest.m_positions.size())),
      m_meanEdge(rest.m_meanEdge),
      m_size(rest.m_size),
      m_tree(rest.m_positions, rest.m_triangles),
      m_ridges(m_features, m_tree),
      m_nearestNode(rest.m_nearestNode),
      m_edgeTriangles(m_features.m_edges.size(), {-1, -1}),
      m_manifoldEdge(m_features.m_edges.size(), 1),
      m_firstAround(rest.m_positions.size() + 1),
      m_change(rest.m_positions.size()),
      m_faceNormal(rest.m_triangles.size()),
      m_place(rest.m_vertices.size()),
      m_bend(m_features.m_edges.size()),
      m_preparedFace(rest.m_triangles.size(), 0),
      m_preparedEdge(m_features.m_edges.size(), 0)
{
    m_nearNodes.reserve(m_tree.nodeCount());
    listEdgeTriangles();
    measureCurvature(rest.m_positions);
    std::vector<std::vector<int>> around(rest.m_positions.size());
    for (const auto& [a, b] : m_features.m_edges)
    {
        around[a].push_back(b);
        around[b].push_back(a);
    }
    for (std::size_t i = 0; i < around.size(); ++i)
    {
        m_around.insert(m_around.end(), around[i].begin(), around[i].end());
        m_firstAround[i + 1] = static_cast<int>(m_around.size());
    }
}

// Curvature from the change of vertex normals along edges. The change across creases counts only where there is no
// other; otherwise the rim of a tyre would have a radius of one element.
void SoftSurface::measureCurvature(const std::vector<Vec3>& x)
{
    std::vector<Vec3> area, facing, normal(x.size());  // area vectors of triangles, their unit normals, vertex normals
    std::vector<std::vector<int>> at(x.size());
    for (std::size_t k = 0; k < m_triangles.size(); ++k)
    {
        const Triangle& t = m_triangles[k];
        area.push_back(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
        facing.push_back(norm(area[k]) > 0 ? unit(area[k]) : Vec3());
        for (int corner : t)
        {
            normal[corner] += area[k];
            at[corner].push_back(static_cast<int>(k));
        }
    }
    for (Vec3& n : normal)
        if (norm(n) > 0) n = unit(n);
    // Normal from the triangles at a vertex that no crease separates from the given triangle.
    const auto smoothNormal = [&](int vertex, std::size_t triangle)
    {
        Vec3 sum;
        for (int k : at[vertex])
            if (dot(facing[k], facing[triangle]) >= kCreaseCosine) sum += area[k];
        return norm(sum) > 0 ? unit(sum) : sum;
    };
    std::vector<double> smooth(x.size(), 0);
    m_fewFacets.assign(x.size(), 0);
    m_curvature.assign(x.size(), 0);
    for (std::size_t k = 0; k < m_triangles.size(); ++k)
        for (int i = 0; i < 3; ++i)
        {
            const int a = m_triangles[k][i], b = m_triangles[k][(i + 1) % 3];
            const Vec3 edge = x[b] - x[a];
            const double square = dot(edge, edge);
            if (!(square > 0)) continue;
            const double whole = dot(normal[b] - normal[a], edge) / square;
            const double part = dot(smoothNormal(b, k) - smoothNormal(a, k), edge) / square;
            for (int end : {a, b})
            {
                m_curvature[end] = std::max(m_curvature[end], whole);
                smooth[end] = std::max(smooth[end], part);
                if (whole * norm(edge) > kFewFacets) m_fewFacets[end] = 1;
            }
        }
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        const bool round = smooth[i] > kRoundShare * m_curvature[i];
        if (round) m_curvature[i] = smooth[i];
        m_fewFacets[i] = m_fewFacets[i] && round;
    }
}

void SoftSurface::listEdgeTriangles()
{
    for (std::size_t t = 0; t < m_triangles.size(); ++t)
        for (int edge : m_features.m_triangleEdges[t])
        {
            std::array<int, 2>& triangles = m_edgeTriangles[edge];
            if (triangles[1] >= 0) m_manifoldEdge[edge] = 0;
            triangles[triangles[0] < 0 ? 0 : 1] = static_cast<int>(t);
        }
    for (std::size_t k = 0; k < m_edgeTriangles.size(); ++k)
        if (m_edgeTriangles[k][1] < 0)
        {
            m_edgeTriangles[k][1] = m_edgeTriangles[k][0];
            m_manifoldEdge[k] = 0;
        }
    m_closed = std::find(m_manifoldEdge.begin(), m_manifoldEdge.end(), 0) == m_manifoldEdge.end();
}

void SoftSurface::setRestNeighbours(std::shared_ptr<const RestNeighbours> neighbours)
{
    m_restNeighbours = std::move(neighbours);
}

void SoftSurface::update(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h)
{
    place(x, v, h);
    prepareAll();
}

void SoftSurface::place(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h)
{
    m_step = h;
    for (std::size_t i = 0; i < v.size(); ++i) m_change[i] = h * v[i];
    m_tree.refit(x, m_change);
}

void SoftSurface::prepareAll()
{
    for (std::size_t t = 0; t < m_faceNormal.size(); ++t) m_faceNormal[t] = normalOf(static_cast<int>(t));
    m_prepared = true;
    for (std::size_t k = 0; k < m_bend.size(); ++k) m_bend[k] = bendOf(static_cast<int>(k));
    m_ridges.update(m_tree, m_bend);
}

void SoftSurface::prepareNear(const std::vector<SurfaceTree::Nearby>& boxes)
{
    m_prepared = false;
    std::fill(m_preparedFace.begin(), m_preparedFace.end(), static_cast<unsigned char>(0));
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
    visitTriangles(
        [this](int t)
        {
            m_faceNormal[t] = normalOf(t);
            m_preparedFace[t] = 1;
        });
    visitTriangles(
        [this](int t)
        {
            for (int edge : m_features.m_triangleEdges[t])
            {
                if (m_preparedEdge[edge]) continue;
                m_bend[edge] = bendOf(edge);
                m_preparedEdge[edge] = 1;
            }
        });
    m_ridges.update(m_tree, m_bend, m_nearNodes);
}

void SoftSurface::notePlace()
{
    for (std::size_t k = 0; k < m_nodes.size(); ++k) m_place[k] = position()[m_nodes[k]];
    m_placeNoted = true;
}

bool SoftSurface::isStill(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h, double reach) const
{
    if (!m_placeNoted) return false;
    for (std::size_t k = 0; k < m_nodes.size(); ++k)
    {
        const int i = m_nodes[k];
        if (!(norm(x[i] - m_place[k]) + h * norm(v[i]) <= reach)) return false;
    }
    return true;
}

void SoftSurface::restorePlace(const std::vector<Vec3>& place)
{
    m_placeNoted = place.size() == m_place.size();
    if (m_placeNoted) m_place.assign(place.begin(), place.end());
}

Vec3 SoftSurface::normalOf(int triangle) const
{
    const Corners c = m_tree.corners(triangle);
    return unit(cross(c[1] - c[0], c[2] - c[0]));
}

// An edge of more than two faces is never a ridge; an edge of the boundary is neither ridge nor groove.
double SoftSurface::bendOf(int edge) const
{
    const auto [first, second] = m_edgeTriangles[edge];
    if (!m_manifoldEdge[edge]) return first == second ? 0 : 1;
    return dot(faceNormal(first), intoFace(edge, second));
}

// The unit vector in a triangle's plane, perpendicular to its edge, into the triangle.
Vec3 SoftSurface::intoFace(int edge, int triangle) const
{
    const auto [a, b] = m_features.m_edges[edge];
    const Triangle& t = m_triangles[triangle];
    const std::vector<Vec3>& x = position();
    const int opposite = t[0] + t[1] + t[2] - a - b;
    const Vec3 e = unit(x[b] - x[a]), r = x[opposite] - x[a];
    return unit(r - dot(r, e) * e);
}

Vec3 SoftSurface::middle() const
{
    const VectorBounds& bounds = m_tree.bounds().m_start;
    return 0.5 * (bounds.m_low + bounds.m_high);
}

std::array<Vec3, 2> SoftSurface::intoFaces(int edge) const
{
    return {intoFace(edge, m_edgeTriangles[edge][0]), intoFace(edge, m_edgeTriangles[edge][1])};
}

// Visits triangles in ascending order, so that sums do not depend on the order of construction.
template <class Visit>
void SoftSurface::visitTrianglesAt(int edge, Visit visit) const
{
    const auto [first, second] = m_edgeTriangles[edge];
    if (m_manifoldEdge[edge])
    {
        visit(first);
        visit(second);
        return;
    }
    const int node = m_features.m_edges[edge][0];
    for (int k = m_features.m_firstAround[node]; k < m_features.m_firstAround[node + 1]; ++k)
    {
        const int t = m_features.m_around[k];
        const std::array<int, 3>& edges = m_features.m_triangleEdges[t];
        if (std::find(edges.begin(), edges.end(), edge) != edges.end()) visit(t);
    }
}

Vec3 SoftSurface::edgeNormal(int edge) const
{
    Vec3 sum;
    visitTrianglesAt(edge, [&](int t) { sum += faceNormal(t); });
    return unit(sum);
}

Vec3 SoftSurface::nodeNormal(int node) const
{
    const std::vector<Vec3>& x = position();
    Vec3 sum;
    for (int k = m_features.m_firstAround[node]; k < m_features.m_firstAround[node + 1]; ++k)
    {
        const int t = m_features.m_around[k];
        const Triangle& nodes = m_triangles[t];
        const int at = nodes[0] == node ? 0 : nodes[1] == node ? 1 : 2;
        const Vec3 next = x[nodes[(at + 1) % 3]] - x[node], last = x[nodes[(at + 2) % 3]] - x[node];
        sum += angleBetween(next, last) * faceNormal(t);
    }
    return unit(sum);
}

Vec3 SoftSurface::normalAt(int triangle, const TrianglePoint& point) const
{
    switch (point.m_feature)
    {
        case TriangleFeature::edge:
            return edgeNormal(m_features.m_triangleEdges[triangle][point.m_number]);
        case TriangleFeature::corner:
            return nodeNormal(m_triangles[triangle][point.m_number]);
        default:
            return faceNormal(triangle);
    }
}

bool SoftSurface::isFlatEdge(int edge) const
{
    const Vec3 normal = edgeNormal(edge);
    bool flat = true;
    visitTrianglesAt(edge, [&](int t) { flat = flat && !(dot(faceNormal(t), normal) < kFlatSurfaceCosine); });
    return flat;
}

bool SoftSurface::isFlatNode(int node) const
{
    const Vec3 normal = nodeNormal(node);
    const int* const around = m_features.m_around.data();
    return std::none_of(around + m_features.m_firstAround[node], around + m_features.m_firstAround[node + 1],
                        [&](int t) { return dot(faceNormal(t), normal) < kFlatSurfaceCosine; });
}

double SoftSurface::minAlongEdges(int node, const Vec3& direction) const
{
    double least = 1;
    for (int k = m_firstAround[node]; k < m_firstAround[node + 1]; ++k)
        least = std::min(least, dot(direction, unit(position()[m_around[k]] - position()[node])));
    return least;
}

}  // namespace bullet_fem
