// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/surface_features.h"

#include <algorithm>

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
}

}  // namespace bullet_fem
