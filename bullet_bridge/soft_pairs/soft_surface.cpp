// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/soft_pairs/soft_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bullet_fem
{
namespace
{

constexpr double kFlat = 0.99;  // cosine of the angle between normals that count as one

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
      m_x(rest.m_positions),
      m_change(rest.m_positions.size()),
      m_faceNormal(rest.m_triangles.size()),
      m_edgeNormal(m_features.m_edges.size()),
      m_nodeNormal(rest.m_positions.size()),
      m_bend(m_features.m_edges.size()),
      m_intoFaces(m_features.m_edges.size()),
      m_flatEdge(m_features.m_edges.size()),
      m_flatNode(rest.m_positions.size())
{
    listEdgeTriangles();
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
}

void SoftSurface::setRestNeighbours(std::shared_ptr<const RestNeighbours> neighbours)
{
    m_restNeighbours = std::move(neighbours);
}

void SoftSurface::update(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h)
{
    m_x.assign(x.begin(), x.end());
    for (std::size_t i = 0; i < v.size(); ++i) m_change[i] = h * v[i];
    m_tree.refit(m_x, m_change);
    updateFaces();
    updateEdges();
    m_ridges.update(m_tree, m_bend);
    updateFlatness();
}

void SoftSurface::updateFaces()
{
    for (int i : m_nodes) m_nodeNormal[i] = {};
    std::fill(m_edgeNormal.begin(), m_edgeNormal.end(), Vec3());
    for (std::size_t t = 0; t < m_faceNormal.size(); ++t)
    {
        const Corners& c = m_tree.corners(static_cast<int>(t));
        const Vec3 n = unit(cross(c[1] - c[0], c[2] - c[0]));
        m_faceNormal[t] = n;
        for (int k = 0; k < 3; ++k)
        {
            m_edgeNormal[m_features.m_triangleEdges[t][k]] += n;
            const Vec3 next = c[(k + 1) % 3] - c[k], last = c[(k + 2) % 3] - c[k];
            m_nodeNormal[m_triangles[t][k]] += angleBetween(next, last) * n;
        }
    }
    for (Vec3& n : m_edgeNormal) n = unit(n);
    for (int i : m_nodes) m_nodeNormal[i] = unit(m_nodeNormal[i]);
}

void SoftSurface::updateEdges()
{
    for (std::size_t k = 0; k < m_bend.size(); ++k)
    {
        const int edge = static_cast<int>(k);
        const auto [first, second] = m_edgeTriangles[k];
        m_intoFaces[k] = {intoFace(edge, first), intoFace(edge, second)};
        // Where more than two faces meet, none may take the edge for a ridge; a rim is neither ridge nor groove.
        const double single = first == second ? 0 : 1;
        m_bend[k] = m_manifoldEdge[k] ? dot(m_faceNormal[first], m_intoFaces[k][1]) : single;
    }
}

// The unit vector from an edge into one of its triangles, perpendicular to the edge.
Vec3 SoftSurface::intoFace(int edge, int triangle) const
{
    const auto [a, b] = m_features.m_edges[edge];
    const Triangle& t = m_triangles[triangle];
    const int opposite = t[0] + t[1] + t[2] - a - b;
    const Vec3 e = unit(m_x[b] - m_x[a]), r = m_x[opposite] - m_x[a];
    return unit(r - dot(r, e) * e);
}

void SoftSurface::updateFlatness()
{
    std::fill(m_flatEdge.begin(), m_flatEdge.end(), static_cast<unsigned char>(1));
    std::fill(m_flatNode.begin(), m_flatNode.end(), static_cast<unsigned char>(1));
    for (std::size_t t = 0; t < m_faceNormal.size(); ++t)
        for (int k = 0; k < 3; ++k)
        {
            const int edge = m_features.m_triangleEdges[t][k], node = m_triangles[t][k];
            if (dot(m_faceNormal[t], m_edgeNormal[edge]) < kFlat) m_flatEdge[edge] = 0;
            if (dot(m_faceNormal[t], m_nodeNormal[node]) < kFlat) m_flatNode[node] = 0;
        }
}

const Vec3& SoftSurface::normalAt(int triangle, const TrianglePoint& point) const
{
    switch (point.m_feature)
    {
        case TriangleFeature::edge:
            return m_edgeNormal[m_features.m_triangleEdges[triangle][point.m_number]];
        case TriangleFeature::corner:
            return m_nodeNormal[m_triangles[triangle][point.m_number]];
        default:
            return m_faceNormal[triangle];
    }
}

double SoftSurface::leastAlongEdges(int node, const Vec3& direction) const
{
    double least = 1;
    for (int k = m_firstAround[node]; k < m_firstAround[node + 1]; ++k)
        least = std::min(least, dot(direction, unit(m_x[m_around[k]] - m_x[node])));
    return least;
}

}  // namespace bullet_fem
