// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

/// Signed distances [m] of points p [m] to solids with sharp edges, centred at the origin, in closed form. The first in
/// the order of the axes is taken among several nearest points. Points in a centre or on an axis get a fixed unit
/// normal.
namespace bullet_fem
{

/// A signed distance with its gradient.
struct PointDistance
{
    double m_gap = 0;  ///< [m], negative inside
    Vec3 m_normal;     ///< unit, outward: the gradient of the gap
};

/// Signed distance to a box of half extents h [m].
PointDistance boxDistance(const Vec3& p, const Vec3& h);

/// Signed distance to a sphere of the given radius [m].
PointDistance sphereDistance(const Vec3& p, double radius);

/// Signed distance to a capsule: the points within `radius` [m] of the segment of +-halfHeight [m] on an axis (0, 1,
/// 2).
PointDistance capsuleDistance(const Vec3& p, int axis, double radius, double halfHeight);

/// Signed distance to a cylinder of the given radius [m] and +-halfHeight [m] along an axis (0, 1, 2).
PointDistance cylinderDistance(const Vec3& p, int axis, double radius, double halfHeight);

/// Signed distance to a cone along an axis (0, 1, 2), with its apex at +halfHeight [m] and its base of the given radius
/// [m] at -halfHeight.
PointDistance coneDistance(const Vec3& p, int axis, double radius, double halfHeight);

/// Signed distance to the half space normal . x <= constant. The normal need not be a unit vector, but must not be
/// zero.
PointDistance planeDistance(const Vec3& p, const Vec3& normal, double constant);

}  // namespace bullet_fem
