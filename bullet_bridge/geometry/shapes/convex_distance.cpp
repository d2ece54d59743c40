// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/convex_distance.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{

namespace
{

constexpr int maxIterations = 100;          // polyhedra need about 10, curved shapes 20
constexpr double relativeAccuracy = 1e-12;  // relative to the distance [-]
constexpr double touchingDistance = 1e-9;   // smallest distance with a reliable direction, relative to the size [-]

bool hasPoint(const MinkowskiSimplex& simplex, const MinkowskiPoint& point)
{
    for (int i = 0; i < simplex.m_count; ++i)
    {
        const Vec3 d = simplex.m_points[i].m_w - point.m_w;
        if (dot(d, d) == 0) return true;
    }
    return false;
}

}  // namespace

bool convexDistance(const MinkowskiDifference& difference, double maxDistance, SurfaceDistance& distance)
{
    const double rounding = difference.m_core.rounding();
    MinkowskiSimplex simplex;
    const Vec3& first = difference.m_soft[0];
    simplex.m_points[0] = difference.support(dot(first, first) > 0 ? -first : Vec3{1, 0, 0});
    simplex.m_count = 1;
    Vec3 v = simplex.m_points[0].m_w;  // point of the simplex nearest to the origin
    double size = norm(v);
    for (int iteration = 0; iteration < maxIterations; ++iteration)
    {
        const double length = norm(v);
        if (!std::isfinite(length)) return false;
        bool inside = length <= touchingDistance * size;
        if (!inside)
        {
            const MinkowskiPoint next = difference.support(-v);
            const double lowerBound = dot(v, next.m_w) / length;
            if (lowerBound - rounding > maxDistance) return false;
            size = std::max(size, norm(next.m_w));
            const double accuracy = relativeAccuracy * length + difference.m_core.precision() * size;
            if (length - lowerBound <= accuracy || hasPoint(simplex, next)) break;

            MinkowskiSimplex larger = simplex;
            larger.m_points[larger.m_count++] = next;
            const Vec3 nearer = larger.reduceToNearest(inside);
            if (!inside && dot(nearer, nearer) >= dot(v, v)) break;  // no progress beyond rounding
            if (!inside)
            {
                simplex = larger;
                v = nearer;
            }
        }
        if (!inside) continue;
        const SurfaceDistance overlap = penetration(difference, simplex);
        if (!(overlap.m_gap <= maxDistance) || !isFinite(overlap.m_normal)) return false;
        distance = overlap;
        return true;
    }
    const double length = norm(v);
    if (!(length - rounding <= maxDistance)) return false;
    distance = {length - rounding, v * (1 / length), simplex.softBarycentric()};
    return true;
}

}  // namespace bullet_fem
