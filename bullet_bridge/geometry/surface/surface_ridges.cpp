// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/surface_ridges.h"

#include <algorithm>

namespace bullet_fem
{

SurfaceRidges::SurfaceRidges(const SurfaceTopology& topology, const SurfaceTree& tree)
{
    const int count = topology.triangleCount();
    std::vector<unsigned char> owned(topology.edgeCount(), 0);
    std::vector<int> owner(topology.edgeCount());
    for (int t = count - 1; t >= 0; --t)
        for (int edge : topology.edgesOf(t)) owner[edge] = t;
    m_firstEdge.push_back(0);
    for (int place = 0; place < count; ++place)
    {
        const int t = tree.triangleAt(place);
        for (int edge : topology.edgesOf(t))
        {
            if (owner[edge] != t || owned[edge]) continue;
            owned[edge] = 1;
            m_edges.push_back({edge, topology.edges()[edge][0], topology.edges()[edge][1]});
        }
        m_firstEdge.push_back(static_cast<int>(m_edges.size()));
    }
    m_end = m_firstEdge;
    m_ridges.resize(m_edges.size());
    m_has.resize(tree.nodeCount());
}

void SurfaceRidges::update(const SurfaceTree& tree, const std::vector<double>& bend)
{
    for (int node = tree.nodeCount() - 1; node >= 0; --node) updateNode(tree, bend, node);
}

void SurfaceRidges::update(const SurfaceTree& tree, const std::vector<double>& bend, const std::vector<int>& nodes)
{
    std::fill(m_has.begin(), m_has.end(), static_cast<unsigned char>(0));
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) updateNode(tree, bend, *node);
}

// Updates a node of the tree; its children must be up to date.
void SurfaceRidges::updateNode(const SurfaceTree& tree, const std::vector<double>& bend, int node)
{
    if (!tree.isLeaf(node))
    {
        const auto [left, right] = tree.children(node);
        m_has[node] = m_has[left] | m_has[right];
        return;
    }
    const SurfaceTree::Leaf leaf = tree.leaf(node);
    int end = m_firstEdge[leaf.m_first];
    for (int k = end; k < m_firstEdge[leaf.m_end]; ++k)
        if (isRidge(bend[m_edges[k].m_edge])) m_ridges[end++] = m_edges[k];
    m_end[leaf.m_first] = end;
    m_has[node] = begin(leaf) != SurfaceRidges::end(leaf);
}

}  // namespace bullet_fem
