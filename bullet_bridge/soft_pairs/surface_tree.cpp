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

SweptBox emptyBox()
{
    constexpr double kBoundless = std::numeric_limits<double>::infinity();
    const Vec3 most{kBoundless, kBoundless, kBoundless};
    return {most, -most, most, -most};
}

}  // namespace

void SweptBox::add(const SweptBox& b)
{
    for (int c = 0; c < 3; ++c)
    {
        m_low[c] = std::min(m_low[c], b.m_low[c]);
        m_high[c] = std::max(m_high[c], b.m_high[c]);
        m_changeLow[c] = std::min(m_changeLow[c], b.m_changeLow[c]);
        m_changeHigh[c] = std::max(m_changeHigh[c], b.m_changeHigh[c]);
    }
}

bool SweptBox::meets(const SweptBox& b, double reach) const
{
    for (int c = 0; c < 3; ++c)
    {
        if (m_low[c] + std::min(0.0, m_changeLow[c] - b.m_changeHigh[c]) > b.m_high[c] + reach) return false;
        if (m_high[c] + std::max(0.0, m_changeHigh[c] - b.m_changeLow[c]) < b.m_low[c] - reach) return false;
    }
    return true;
}

double SweptBox::squaredDistance(const Vec3& p) const
{
    double sum = 0;
    for (int c = 0; c < 3; ++c)
    {
        const double d = std::max({m_low[c] - p[c], p[c] - m_high[c], 0.0});
        sum += d * d;
    }
    return sum;
}

SurfaceTree::SurfaceTree(const std::vector<Vec3>& restPositions, const std::vector<Triangle>& triangles)
    : m_triangles(triangles), m_corners(triangles.size()), m_order(triangles.size())
{
    std::vector<Vec3> middles;
    for (const Triangle& t : triangles)
        middles.push_back((1.0 / 3) * (restPositions[t[0]] + restPositions[t[1]] + restPositions[t[2]]));
    std::iota(m_order.begin(), m_order.end(), 0);
    build(0, static_cast<int>(triangles.size()), middles);
    refit(restPositions, std::vector<Vec3>(restPositions.size()));
}

int SurfaceTree::build(int first, int count, std::vector<Vec3>& middles)
{
    const int at = static_cast<int>(m_nodes.size());
    m_nodes.emplace_back();
    m_nodes[at].m_first = first;
    m_nodes[at].m_count = count;
    if (count <= kLeafTriangles) return at;

    SweptBox box = emptyBox();
    for (int k = first; k < first + count; ++k) box.add(SweptBox::of(middles[m_order[k]], {}));
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
    for (int at = static_cast<int>(m_nodes.size()) - 1; at >= 0; --at)
    {
        Node& node = m_nodes[at];
        node.m_box = emptyBox();
        for (int k = node.m_first; k < node.m_first + node.m_count; ++k)
        {
            const Triangle& t = m_triangles[m_order[k]];
            m_corners[m_order[k]] = {x[t[0]], x[t[1]], x[t[2]]};
            for (int i : t) node.m_box.add(SweptBox::of(x[i], change[i]));
        }
        if (node.m_count > 0 || m_triangles.empty()) continue;
        node.m_box.add(m_nodes[at + 1].m_box);
        node.m_box.add(m_nodes[node.m_right].m_box);
    }
}

}  // namespace bullet_fem
