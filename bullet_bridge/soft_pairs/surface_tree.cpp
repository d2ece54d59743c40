// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/soft_pairs/surface_tree.h"

#include <algorithm>
#include <numeric>

namespace bullet_fem
{
namespace
{

constexpr int kLeafTriangles = 2;

}  // namespace

SurfaceTree::SurfaceTree(const std::vector<Vec3>& restPositions, const std::vector<Triangle>& triangles)
    : m_triangles(triangles), m_corners(triangles.size()), m_order(triangles.size())
{
    std::vector<Vec3> middles;
    for (const Triangle& t : triangles)
        middles.push_back((1.0 / 3) * (restPositions[t[0]] + restPositions[t[1]] + restPositions[t[2]]));
    std::iota(m_order.begin(), m_order.end(), 0);
    build(0, static_cast<int>(triangles.size()), middles);
    m_starts.resize(m_nodes.size());
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
    m_nodes[at].m_first = first;
    m_nodes[at].m_count = count;
    if (count <= kLeafTriangles) return at;

    VectorBounds box;
    for (int k = first; k < first + count; ++k) box.add({middles[m_order[k]], middles[m_order[k]]});
    const Vec3 size = box.m_high - box.m_low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto before = [&](int a, int b)
    { return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b; };
    const int half = count / 2;
    std::nth_element(m_order.begin() + first, m_order.begin() + first + half, m_order.begin() + first + count, before);
    m_nodes[at].m_count = 0;
    build(first, half, middles);
    m_nodes[at].m_right = build(first + half, count - half, middles);
    return at;
}

void SurfaceTree::refit(const std::vector<Vec3>& x, const std::vector<Vec3>& change)
{
    m_bounds = {};
    for (int i : m_vertices)
    {
        m_bounds.add(SweptBox::of(x[i], change[i]));
        m_vertexBoxes[i] = CoarseBox::of(x[i], change[i]);
    }
    for (int at = static_cast<int>(m_nodes.size()) - 1; at >= 0; --at)
    {
        Node& node = m_nodes[at];
        node.m_box = CoarseBox::empty();
        m_starts[at] = {};
        for (int k = node.m_first; k < node.m_first + node.m_count; ++k)
        {
            const Triangle& t = m_triangles[m_order[k]];
            m_corners[m_order[k]] = {x[t[0]], x[t[1]], x[t[2]]};
            for (int i : t)
            {
                node.m_box.add(m_vertexBoxes[i]);
                m_starts[at].add({x[i], x[i]});
            }
        }
        if (node.m_count > 0 || m_triangles.empty()) continue;
        for (int child : {at + 1, node.m_right})
        {
            node.m_box.add(m_nodes[child].m_box);
            m_starts[at].add(m_starts[child]);
        }
    }
}

}  // namespace bullet_fem
