// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/surface_features.h"

#include <algorithm>
#include <numeric>

namespace bullet_fem
{

SurfaceFeatures::SurfaceFeatures(const std::vector<Triangle>& triangles, int vertexCount)
{
    const auto edgeOf = [](const Triangle& t, int k) {
        return std::array<int, 2>{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
    };
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k) m_edges.push_back(edgeOf(t, k));
    std::sort(m_edges.begin(), m_edges.end());
    m_edges.erase(std::unique(m_edges.begin(), m_edges.end()), m_edges.end());
    for (const Triangle& t : triangles)
    {
        std::array<int, 3> edges;
        for (int k = 0; k < 3; ++k)
            edges[k] =
                static_cast<int>(std::lower_bound(m_edges.begin(), m_edges.end(), edgeOf(t, k)) - m_edges.begin());
        m_triangleEdges.push_back(edges);
    }
    m_firstAround.assign(vertexCount + 1, 0);
    for (const Triangle& t : triangles)
        for (int node : t) ++m_firstAround[node + 1];
    std::partial_sum(m_firstAround.begin(), m_firstAround.end(), m_firstAround.begin());
    m_around.resize(3 * triangles.size());
    std::vector<int> next(m_firstAround.begin(), m_firstAround.end() - 1);
    for (std::size_t k = 0; k < triangles.size(); ++k)
        for (int node : triangles[k]) m_around[next[node]++] = static_cast<int>(k);
}

}  // namespace bullet_fem
