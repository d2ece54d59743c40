// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/surface_topology.h"

#include <numeric>

namespace bullet_fem
{

SurfaceTopology::SurfaceTopology(const std::vector<Triangle>& triangles, int vertexCount)
    : m_triangles(triangles), m_firstAround(vertexCount + 1, 0), m_around(3 * triangles.size())
{
    listEdges();
    listEdgeTriangles();
    for (const Triangle& t : triangles)
        for (int vertex : t) ++m_firstAround[vertex + 1];
    for (int i = 0; i < vertexCount; ++i)
        if (m_firstAround[i + 1] > 0) m_vertices.push_back(i);
    std::partial_sum(m_firstAround.begin(), m_firstAround.end(), m_firstAround.begin());
    std::vector<int> next(m_firstAround.begin(), m_firstAround.end() - 1);
    for (std::size_t k = 0; k < triangles.size(); ++k)
        for (int vertex : triangles[k]) m_around[next[vertex]++] = static_cast<int>(k);
}

void SurfaceTopology::listEdges()
{
    const auto edgeOf = [](const Triangle& t, int k) {
        return std::array<int, 2>{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
    };
    for (const Triangle& t : m_triangles)
        for (int k = 0; k < 3; ++k) m_edges.push_back(edgeOf(t, k));
    std::sort(m_edges.begin(), m_edges.end());
    m_edges.erase(std::unique(m_edges.begin(), m_edges.end()), m_edges.end());
    for (const Triangle& t : m_triangles)
    {
        std::array<int, 3> edges;
        for (int k = 0; k < 3; ++k)
            edges[k] =
                static_cast<int>(std::lower_bound(m_edges.begin(), m_edges.end(), edgeOf(t, k)) - m_edges.begin());
        m_triangleEdges.push_back(edges);
    }
}

void SurfaceTopology::listEdgeTriangles()
{
    m_edgeTriangles.assign(m_edges.size(), {-1, -1});
    std::vector<int> count(m_edges.size(), 0);
    for (int t = 0; t < triangleCount(); ++t)
        for (int edge : m_triangleEdges[t])
        {
            if (++count[edge] == 1) m_edgeTriangles[edge][0] = t;
            m_edgeTriangles[edge][1] = t;
        }
    for (int k : count) m_isManifold.push_back(k == 2);
    m_isClosed = std::all_of(count.begin(), count.end(), [](int k) { return k == 2; });
}

}  // namespace bullet_fem
