// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/surface_tree.h"

#include <algorithm>
#include <numeric>

namespace bullet_fem
{

SurfaceTree::SurfaceTree(const std::vector<Vec3>& restPositions, const std::vector<Triangle>& triangles)
    : m_triangles(triangles), m_order(triangles.size())
{
    std::vector<Vec3> middles;
    for (const Triangle& t : triangles)
        middles.push_back((1.0 / 3) * (restPositions[t[0]] + restPositions[t[1]] + restPositions[t[2]]));
    std::iota(m_order.begin(), m_order.end(), 0);
    build(0, static_cast<int>(triangles.size()), middles);
    m_boxes.resize(m_nodes.size(), CoarseBox::empty());
    m_parts.resize(m_nodes.size());
    for (int t : m_order) m_placed.push_back(triangles[t]);
    m_vertexBoxes.resize(restPositions.size());
    for (const Triangle& t : triangles) m_vertices.insert(m_vertices.end(), t.begin(), t.end());
    std::sort(m_vertices.begin(), m_vertices.end());
    m_vertices.erase(std::unique(m_vertices.begin(), m_vertices.end()), m_vertices.end());
    refit(restPositions, std::vector<Vec3>(restPositions.size()));
}

int SurfaceTree::build(int first, int count, std::vector<Vec3>& middles)
{
    const int at = static_cast<int>(m_nodes.size());
    m_nodes.emplace_back();
    if (count <= kLeafTriangles)
    {
        m_nodes[at] = {first, count};
        return at;
    }

    VectorBounds box;
    for (int k = first; k < first + count; ++k) box.add({middles[m_order[k]], middles[m_order[k]]});
    const Vec3 size = box.m_high - box.m_low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto before = [&](int a, int b)
    { return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b; };
    const int half = count / 2;
    std::nth_element(m_order.begin() + first, m_order.begin() + first + half, m_order.begin() + first + count, before);
    build(first, half, middles);
    const int right = build(first + half, count - half, middles);
    m_nodes[at].m_next = right;
    return at;
}

void SurfaceTree::refit(const std::vector<Vec3>& x, const std::vector<Vec3>& change)
{
    m_x.assign(x.begin(), x.end());
    m_bounds = {};
    for (int i : m_vertices)
    {
        m_bounds.m_change.add({change[i], change[i]});
        m_vertexBoxes[i] = CoarseBox::of(x[i], change[i]);
    }
    if (m_triangles.empty()) return;
    for (int at = nodeCount() - 1; at >= 0; --at)
    {
        const Node& node = m_nodes[at];
        CoarseBox box = CoarseBox::empty();
        if (node.isLeaf())
        {
            const Triangle &first = m_placed[node.m_next], &last = m_placed[node.m_next + node.m_count - 1];
            for (int i : first) box.add(m_vertexBoxes[i]);
            for (int i : last) box.add(m_vertexBoxes[i]);
            m_parts[at] = BoxPair::of(m_x, first, last);
        }
        else
        {
            const auto [left, right] = children(at);
            box = m_boxes[left];
            box.add(m_boxes[right]);
            m_parts[at] = BoxPair::around(m_parts[left], m_parts[right]);
        }
        m_boxes[at] = box;
    }
    m_bounds.m_start = m_parts.front()[0];
    m_bounds.m_start.add(m_parts.front()[1]);
}

}  // namespace bullet_fem
