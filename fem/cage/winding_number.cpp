// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/winding_number.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr double kFullAngle = 4 * 3.14159265358979323846;  // full solid angle [sr]
constexpr int kMaxInLeaf = 8;
constexpr double kFarRatio = 2;  // distance over radius beyond which moments are used: beta of [Barill et al. 2018]

Vec3 vectorArea(const Vec3& a, const Vec3& b, const Vec3& c)
{
    return 0.5 * cross(b - a, c - a);
}

/// A sum of solid angles of triangles seen from the origin. Half of each is the argument of a complex number [van
/// Oosterom & Strackee 1983, eq. 8]; numbers in the right half plane are multiplied before taking a single argument,
/// because the argument costs more than all other operations.
class SolidAngles
{
public:
    /// Positive if the triangle's normal points away from the origin.
    void add(const Vec3& a, const Vec3& b, const Vec3& c)
    {
        const double la = norm(a), lb = norm(b), lc = norm(c), scale = 1 / (la * lb * lc);
        const double im = dot(a, cross(b, c)) * scale;
        const double re = 1 + (dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb) * scale;
        if (im == 0 || !std::isfinite(scale)) return;  // coplanar with the origin, or a corner there
        if (!(re > 0))
        {
            m_sum += 2 * std::atan2(im, re);
            return;
        }
        const double product = m_re * re - m_im * im;
        m_im = m_re * im + m_im * re;
        m_re = product;
        if (!(m_re > kSmall && m_re < 1 / kSmall && std::abs(m_im) < 1 / kSmall)) flush();
    }

    double sum()
    {
        flush();
        return m_sum;
    }

private:
    // Products of small numbers, from thin triangles, could underflow.
    static constexpr double kSmall = 1e-100;

    void flush()
    {
        m_sum += 2 * std::atan2(m_im, m_re);
        m_re = 1;
        m_im = 0;
    }

    double m_sum = 0;
    double m_re = 1, m_im = 0;  // the product, in the right half plane
};

}  // namespace

WindingNumber::WindingNumber(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles)
{
    for (const Triangle& t : triangles) m_triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
    if (!m_triangles.empty()) build(0, static_cast<int>(m_triangles.size()));
}

void WindingNumber::build(int first, int last)
{
    const std::size_t self = m_nodes.size();
    m_nodes.push_back(summarise(first, last));
    if (last - first <= kMaxInLeaf)
        m_nodes[self].m_leaf = true;
    else
    {
        Vec3 low = m_triangles[first].m_a, high = low;
        for (int t = first; t < last; ++t)
            for (int a = 0; a < 3; ++a)
            {
                low[a] = std::min(low[a], m_triangles[t].m_a[a]);
                high[a] = std::max(high[a], m_triangles[t].m_a[a]);
            }
        const Vec3 extent = high - low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const int middle = first + (last - first) / 2;
        const auto along = [axis](const Corners& t) { return t.m_a[axis] + t.m_b[axis] + t.m_c[axis]; };
        std::nth_element(m_triangles.begin() + first, m_triangles.begin() + middle, m_triangles.begin() + last,
                         [&](const Corners& s, const Corners& t) { return along(s) < along(t); });
        build(first, middle);
        build(middle, last);
    }
    m_nodes[self].m_skip = static_cast<int>(m_nodes.size());
}

WindingNumber::Node WindingNumber::summarise(int first, int last) const
{
    Node node;
    node.m_first = first;
    node.m_last = last;
    double area = 0;
    for (int t = first; t < last; ++t)
    {
        const auto& [a, b, c] = m_triangles[t];
        const double weight = norm(vectorArea(a, b, c));
        node.m_vectorArea += vectorArea(a, b, c);
        node.m_centre += weight / 3 * (a + b + c);
        area += weight;
    }
    node.m_centre = area > 0 ? node.m_centre * (1 / area) : m_triangles[first].m_a;

    double radius = 0;
    for (int t = first; t < last; ++t)
    {
        const auto& [a, b, c] = m_triangles[t];
        node.m_moment += outer(vectorArea(a, b, c), (a + b + c) * (1.0 / 3) - node.m_centre);
        for (const Vec3& x : {a, b, c}) radius = std::max(radius, norm(x - node.m_centre));
    }
    node.m_farSquared = kFarRatio * kFarRatio * radius * radius;
    return node;
}

/// The solid angle of a patch of vector area a n at r + d, to first order in d = c - centre, is
///     a (n.r / |r|^3 + n.d / |r|^3 - 3 (n.r)(r.d) / |r|^5);
/// summed over a node: (N.r + tr C) / |r|^3 - 3 r.C r / |r|^5 [Barill et al. 2018, eq. 13].
double WindingNumber::at(const Vec3& p) const
{
    double angle = 0;
    SolidAngles near;
    for (std::size_t n = 0; n < m_nodes.size();)
    {
        const Node& node = m_nodes[n];
        const Vec3 r = node.m_centre - p;
        const double r2 = dot(r, r);
        if (r2 > node.m_farSquared)
        {
            const double r3 = r2 * std::sqrt(r2);
            angle +=
                (dot(node.m_vectorArea, r) + trace(node.m_moment)) / r3 - 3 * dot(r, node.m_moment * r) / (r3 * r2);
        }
        else if (node.m_leaf)
            for (int t = node.m_first; t < node.m_last; ++t)
                near.add(m_triangles[t].m_a - p, m_triangles[t].m_b - p, m_triangles[t].m_c - p);
        else
        {
            ++n;
            continue;
        }
        n = node.m_skip;
    }
    return (angle + near.sum()) / kFullAngle;
}

}  // namespace bullet_fem
