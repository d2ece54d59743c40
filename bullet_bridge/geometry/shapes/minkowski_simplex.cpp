// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/minkowski_simplex.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bullet_fem
{

namespace
{

/// The point of a face (sub-simplex) nearest to the origin.
struct Nearest
{
    Vec3 m_point;
    std::array<double, 4> m_weights = {0, 0, 0, 0};  ///< of the simplex's points

    double squaredDistance() const { return dot(m_point, m_point); }
};

using Points = std::array<MinkowskiPoint, 4>;

Nearest nearestOnPoint(const Points& p, int i)
{
    Nearest nearest;
    nearest.m_point = p[i].m_w;
    nearest.m_weights[i] = 1;
    return nearest;
}

Nearest nearestOnSegment(const Points& p, int i, int j)
{
    const Vec3 a = p[i].m_w, ab = p[j].m_w - a;
    const double t = -dot(a, ab), length2 = dot(ab, ab);
    if (!(t > 0)) return nearestOnPoint(p, i);
    if (t >= length2) return nearestOnPoint(p, j);
    Nearest nearest;
    nearest.m_weights[j] = t / length2;
    nearest.m_weights[i] = 1 - nearest.m_weights[j];
    nearest.m_point = a + ab * nearest.m_weights[j];
    return nearest;
}

Nearest nearestOnTriangle(const Points& p, int i, int j, int k)
{
    const Vec3 a = p[i].m_w, b = p[j].m_w, c = p[k].m_w, n = cross(b - a, c - a);
    const double n2 = dot(n, n);
    if (n2 > 0)
    {
        // Barycentric coordinates of the origin's projection on the plane, as ratios of areas.
        const double wa = dot(n, cross(b, c)) / n2, wb = dot(n, cross(c, a)) / n2, wc = dot(n, cross(a, b)) / n2;
        if (wa >= 0 && wb >= 0 && wc >= 0)
        {
            Nearest nearest;
            nearest.m_weights[i] = wa / (wa + wb + wc);
            nearest.m_weights[j] = wb / (wa + wb + wc);
            nearest.m_weights[k] = wc / (wa + wb + wc);
            nearest.m_point =
                n * (dot(n, a) / n2);  // exactly along the normal, while a weighted sum of a, b, c has rounding errors
            return nearest;
        }
    }
    const Nearest edges[] = {nearestOnSegment(p, i, j), nearestOnSegment(p, j, k), nearestOnSegment(p, k, i)};
    return *std::min_element(std::begin(edges), std::end(edges),
                             [](const Nearest& e, const Nearest& f)
                             { return e.squaredDistance() < f.squaredDistance(); });
}

/// The nearest point on the faces that have the origin on their outer side. A flat tetrahedron has it on the outer side
/// of all.
Nearest nearestOnTetrahedron(const Points& p, bool& inside)
{
    // three corners and the opposite one
    static const int faces[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}};
    Nearest nearest;
    double nearest2 = std::numeric_limits<double>::infinity();
    for (const auto& f : faces)
    {
        const Vec3 a = p[f[0]].m_w, ab = p[f[1]].m_w - a, ac = p[f[2]].m_w - a, ad = p[f[3]].m_w - a, n = cross(ab, ac);
        const double height = dot(n, ad);
        const bool flat = std::abs(height) <= 1e-14 * norm(ab) * norm(ac) * norm(ad);
        if (!flat && -dot(n, a) * height >= 0) continue;
        const Nearest onFace = nearestOnTriangle(p, f[0], f[1], f[2]);
        if (onFace.squaredDistance() >= nearest2) continue;
        nearest = onFace;
        nearest2 = onFace.squaredDistance();
    }
    inside = nearest2 == std::numeric_limits<double>::infinity();
    return nearest;
}

}  // namespace

MinkowskiPoint MinkowskiDifference::support(const Vec3& direction) const
{
    int farthest = 0;
    for (int i = 1; i < m_softCount; ++i)
        if (dot(direction, m_soft[i]) > dot(direction, m_soft[farthest])) farthest = i;
    return {m_soft[farthest] - m_core.support(-direction), farthest};
}

Vec3 MinkowskiSimplex::reduceToNearest(bool& inside)
{
    inside = false;
    const Nearest nearest = m_count == 1   ? nearestOnPoint(m_points, 0)
                            : m_count == 2 ? nearestOnSegment(m_points, 0, 1)
                            : m_count == 3 ? nearestOnTriangle(m_points, 0, 1, 2)
                                           : nearestOnTetrahedron(m_points, inside);
    if (inside) return {};
    int kept = 0;
    for (int i = 0; i < m_count; ++i)
    {
        if (nearest.m_weights[i] == 0) continue;
        m_points[kept] = m_points[i];
        m_weights[kept++] = nearest.m_weights[i];
    }
    m_count = kept;
    return nearest.m_point;
}

std::array<double, 3> MinkowskiSimplex::softBarycentric() const
{
    std::array<double, 3> barycentric = {0, 0, 0};
    double sum = 0;
    for (int i = 0; i < m_count; ++i)
    {
        barycentric[m_points[i].m_softIndex] += m_weights[i];
        sum += m_weights[i];
    }
    for (double& share : barycentric) share /= sum;
    return barycentric;
}

}  // namespace bullet_fem
