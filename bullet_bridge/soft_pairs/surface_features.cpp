// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/soft_pairs/surface_features.h"

#include <algorithm>
#include <numeric>

namespace bullet_fem
{

SurfaceFeatures::SurfaceFeatures(const TetMesh& mesh)
{
    const auto edgeOf = [](const Triangle& t, int k) {
        return std::array<int, 2>{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
    };
    for (const Triangle& t : mesh.surface())
        for (int k = 0; k < 3; ++k) m_edges.push_back(edgeOf(t, k));
    std::sort(m_edges.begin(), m_edges.end());
    m_edges.erase(std::unique(m_edges.begin(), m_edges.end()), m_edges.end());
    for (const Triangle& t : mesh.surface())
    {
        std::array<int, 3> edges;
        for (int k = 0; k < 3; ++k)
            edges[k] =
                static_cast<int>(std::lower_bound(m_edges.begin(), m_edges.end(), edgeOf(t, k)) - m_edges.begin());
        m_triangleEdges.push_back(edges);
    }
    m_firstAround.assign(mesh.nodeCount() + 1, 0);
    for (const Triangle& t : mesh.surface())
        for (int node : t) ++m_firstAround[node + 1];
    std::partial_sum(m_firstAround.begin(), m_firstAround.end(), m_firstAround.begin());
    m_around.resize(3 * mesh.surface().size());
    std::vector<int> next(m_firstAround.begin(), m_firstAround.end() - 1);
    for (std::size_t k = 0; k < mesh.surface().size(); ++k)
        for (int node : mesh.surface()[k]) m_around[next[node]++] = static_cast<int>(k);
}

}  // namespace bullet_fem
