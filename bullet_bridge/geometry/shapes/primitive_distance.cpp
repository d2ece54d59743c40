// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/primitive_distance.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{

namespace
{

Vec3 unitAxis(int axis)
{
    Vec3 e;
    e[axis] = 1;
    return e;
}

/// A signed distance and its gradient in the half plane (r, y) of a solid of revolution.
struct ProfileDistance
{
    double m_gap, m_normalR, m_normalY;
};

/// Distance and direction from (a, b) to (r, y); the fallback's direction if the points are equal.
ProfileDistance fromPoint(double r, double y, double a, double b, const ProfileDistance& fallback)
{
    const double d = std::hypot(r - a, y - b);
    return d > 0 ? ProfileDistance{d, (r - a) / d, (y - b) / d}
                 : ProfileDistance{0, fallback.m_normalR, fallback.m_normalY};
}

/// A point's cylindrical coordinates about an axis.
struct Cylindrical
{
    double m_r, m_y;
    Vec3 m_radial;  ///< unit; an arbitrary fixed one for points on the axis

    Cylindrical(const Vec3& p, int axis) : m_y(p[axis])
    {
        m_radial = p;
        m_radial[axis] = 0;
        m_r = norm(m_radial);
        m_radial = m_r > 0 ? m_radial * (1 / m_r) : unitAxis((axis + 1) % 3);
    }
    PointDistance revolve(const ProfileDistance& d, int axis) const
    {
        return {d.m_gap, d.m_normalR * m_radial + d.m_normalY * unitAxis(axis)};
    }
};

}  // namespace

PointDistance boxDistance(const Vec3& p, const Vec3& h)
{
    Vec3 outside;
    int nearest = 0;
    for (int i = 0; i < 3; ++i)
    {
        outside[i] = p[i] - std::clamp(p[i], -h[i], h[i]);
        if (std::abs(p[i]) - h[i] > std::abs(p[nearest]) - h[nearest]) nearest = i;
    }
    const double d = norm(outside);
    if (d > 0) return {d, outside * (1 / d)};
    return {std::abs(p[nearest]) - h[nearest], unitAxis(nearest) * (p[nearest] < 0 ? -1 : 1)};
}

PointDistance sphereDistance(const Vec3& p, double radius)
{
    const double d = norm(p);
    return {d - radius, d > 0 ? p * (1 / d) : unitAxis(1)};
}

PointDistance capsuleDistance(const Vec3& p, int axis, double radius, double halfHeight)
{
    const Cylindrical c(p, axis);
    const double nearest = std::clamp(c.m_y, -halfHeight, halfHeight);
    ProfileDistance d = fromPoint(c.m_r, c.m_y, 0, nearest, {0, 1, 0});
    d.m_gap -= radius;
    return c.revolve(d, axis);
}

PointDistance cylinderDistance(const Vec3& p, int axis, double radius, double halfHeight)
{
    const Cylindrical c(p, axis);
    const double side = c.m_r - radius, cap = std::abs(c.m_y) - halfHeight, up = c.m_y < 0 ? -1 : 1;
    if (side > 0 && cap > 0) return c.revolve(fromPoint(c.m_r, c.m_y, radius, up * halfHeight, {0, 0, up}), axis);
    return c.revolve(side > cap ? ProfileDistance{side, 1, 0} : ProfileDistance{cap, 0, up}, axis);
}

PointDistance coneDistance(const Vec3& p, int axis, double radius, double halfHeight)
{
    const Cylindrical c(p, axis);
    // The profile is a triangle: base, and slant from the apex (0, halfHeight) to the rim (radius, -halfHeight).
    const double slant = std::hypot(radius, 2 * halfHeight);
    const double slantR = slant > 0 ? radius / slant : 0, slantY = slant > 0 ? -2 * halfHeight / slant : -1;
    const ProfileDistance side = {-slantY * c.m_r + slantR * (c.m_y - halfHeight), -slantY, slantR};
    const ProfileDistance base = {-halfHeight - c.m_y, 0, -1};
    const ProfileDistance& nearestFace = side.m_gap > base.m_gap ? side : base;
    if (nearestFace.m_gap <= 0) return c.revolve(nearestFace, axis);

    if (base.m_gap > 0 && c.m_r <= radius) return c.revolve(base, axis);
    const double along = slantR * c.m_r + slantY * (c.m_y - halfHeight);  // distance from the apex along the slant
    if (along <= 0) return c.revolve(fromPoint(c.m_r, c.m_y, 0, halfHeight, side), axis);
    if (along >= slant) return c.revolve(fromPoint(c.m_r, c.m_y, radius, -halfHeight, base), axis);
    return c.revolve(side, axis);
}

PointDistance planeDistance(const Vec3& p, const Vec3& normal, double constant)
{
    const double length = norm(normal);
    return {(dot(normal, p) - constant) / length, normal * (1 / length)};
}

}  // namespace bullet_fem
