// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/surface_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace bullet_fem
{

std::vector<int> weldCoincident(const std::vector<Vec3>& x)
{
    const auto key = [&](int i) { return std::tie(x[i].x, x[i].y, x[i].z); };
    std::vector<int> order(x.size()), first(x.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int i, int j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
    for (std::size_t n = 0; n < order.size(); ++n)
        first[order[n]] = n > 0 && key(order[n]) == key(order[n - 1]) ? first[order[n - 1]] : order[n];
    return first;
}

std::vector<TriangleSide> sortedSides(const std::vector<Triangle>& triangles, const std::vector<int>& welded)
{
    std::vector<TriangleSide> sides;
    sides.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int a = 0; a < 3; ++a)
        {
            const int i = welded[triangles[t][a]], j = welded[triangles[t][(a + 1) % 3]];
            if (i != j) sides.push_back({std::min(i, j), std::max(i, j), static_cast<int>(t), i < j ? 1 : -1});
        }
    const auto key = [](const TriangleSide& s) { return std::tie(s.m_low, s.m_high, s.m_triangle, s.m_way); };
    std::sort(sides.begin(), sides.end(),
              [&](const TriangleSide& s, const TriangleSide& t) { return key(s) < key(t); });
    return sides;
}

}  // namespace bullet_fem
