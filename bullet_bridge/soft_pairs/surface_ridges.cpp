// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/soft_pairs/surface_ridges.h"

namespace bullet_fem
{

SurfaceRidges::SurfaceRidges(const SurfaceFeatures& features, const SurfaceTree& tree)
{
    const int count = static_cast<int>(features.m_triangleEdges.size());
    std::vector<unsigned char> owned(features.m_edges.size(), 0);
    std::vector<int> owner(features.m_edges.size());
    for (int t = count - 1; t >= 0; --t)
        for (int edge : features.m_triangleEdges[t]) owner[edge] = t;
    m_firstEdge.push_back(0);
    for (int place = 0; place < count; ++place)
    {
        const int t = tree.triangleAt(place);
        for (int edge : features.m_triangleEdges[t])
        {
            if (owner[edge] != t || owned[edge]) continue;
            owned[edge] = 1;
            m_edges.push_back({edge, features.m_edges[edge][0], features.m_edges[edge][1]});
        }
        m_firstEdge.push_back(static_cast<int>(m_edges.size()));
    }
    m_first.resize(m_firstEdge.size());
    m_ridges.reserve(m_edges.size());
    m_has.resize(tree.nodeCount());
}

void SurfaceRidges::update(const SurfaceTree& tree, const std::vector<double>& bend)
{
    m_ridges.clear();
    for (std::size_t place = 0; place + 1 < m_firstEdge.size(); ++place)
    {
        m_first[place] = static_cast<int>(m_ridges.size());
        for (int k = m_firstEdge[place]; k < m_firstEdge[place + 1]; ++k)
            if (isRidge(bend[m_edges[k].m_edge])) m_ridges.push_back(m_edges[k]);
    }
    m_first.back() = static_cast<int>(m_ridges.size());
    for (int node = tree.nodeCount() - 1; node >= 0; --node)
    {
        if (tree.isLeaf(node))
        {
            m_has[node] = begin(tree.leaf(node)) != end(tree.leaf(node));
            continue;
        }
        const auto [left, right] = tree.children(node);
        m_has[node] = m_has[left] | m_has[right];
    }
}

}  // namespace bullet_fem
