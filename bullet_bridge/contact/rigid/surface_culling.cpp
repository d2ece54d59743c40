// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/surface_culling.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
void SurfaceCulling::begin(const SoftSurface& surface, const std::vector<Vec3>& x)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    m_x = &x;
    m_outside.resize(x.size());
    m_gaps.resize(x.size());
    m_low = {kInfinity, kInfinity, kInfinity};
    m_high = -m_low;
    for (int i : surface.topology().vertices()) include(x[i]);
    double longest = 0;
    for (const auto& [a, b] : surface.topology().edges())
    {
        const Vec3 edge = x[b] - x[a];
        longest = std::max(longest, dot(edge, edge));
    }
    m_longestEdge = std::sqrt(longest);
}

void SurfaceCulling::include(const Vec3& x)
{
    for (int c = 0; c < 3; ++c)
    {
        m_low[c] = std::min(m_low[c], x[c]);
        m_high[c] = std::max(m_high[c], x[c]);
    }
}

bool SurfaceCulling::meets(const Bounds& bounds)
{
    m_bounds = bounds;
    for (int c = 0; c < 3; ++c)
        if (m_high[c] < bounds.m_low[c] - bounds.m_reach || m_low[c] > bounds.m_high[c] + bounds.m_reach) return false;
    return true;
}

bool SurfaceCulling::noteVertex(int vertex, const Vec3& start, const Vec3& end)
{
    unsigned outside = 0;
    for (int c = 0; c < 3; ++c)
    {
        if (std::max(start[c], end[c]) < m_bounds.m_low[c] - m_bounds.m_reach) outside |= 1u << (2 * c);
        if (std::min(start[c], end[c]) > m_bounds.m_high[c] + m_bounds.m_reach) outside |= 2u << (2 * c);
    }
    m_outside[vertex] = static_cast<unsigned char>(outside);
    return outside == 0;
}

// Lower bound of the gap on a triangle. The gap f to a convex shape is convex: f(p) >= f(x) + grad f(x) . (p - x), and
// the right side is smallest in a corner.
double SurfaceCulling::minGap(int vertex, const Triangle& t) const
{
    double least = 0;
    for (int i : t)
        if (i != vertex) least = std::min(least, dot(m_gaps[vertex].m_normal, (*m_x)[i] - (*m_x)[vertex]));
    return m_gaps[vertex].m_gap + least;
}

double SurfaceCulling::minGap(const Triangle& t) const
{
    const double least = std::max(minGap(t[0], t), minGap(t[1], t));
    return t[2] == t[0] ? least : std::max(least, minGap(t[2], t));
}

}  // namespace bullet_fem
