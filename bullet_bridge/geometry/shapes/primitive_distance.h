// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

/// Signed distances of points to sharp solids about the origin, in closed form. Of several equally near points the
/// first in the order of the axes is taken; a point in a centre or on an axis gets a fixed unit normal.
namespace bullet_fem
{

/// A signed distance with its gradient.
struct PointDistance
{
    double m_gap = 0;  ///< [m], negative inside
    Vec3 m_normal;     ///< unit, outward: the gradient of the gap
};

/// To a box of half extents h [m].
PointDistance boxDistance(const Vec3& p, const Vec3& h);

/// To a sphere [m].
PointDistance sphereDistance(const Vec3& p, double radius);

/// To a capsule: all that is nearer than radius [m] to the segment of +-halfHeight [m] on an axis (0, 1, 2).
PointDistance capsuleDistance(const Vec3& p, int axis, double radius, double halfHeight);

/// To a cylinder of +-halfHeight [m] about an axis (0, 1, 2).
PointDistance cylinderDistance(const Vec3& p, int axis, double radius, double halfHeight);

/// To a cone about an axis (0, 1, 2), its apex at +halfHeight [m], its base of the given radius [m] at -halfHeight.
PointDistance coneDistance(const Vec3& p, int axis, double radius, double halfHeight);

/// To the half space below normal . x = constant; the normal need not be of unit length, but not zero.
PointDistance planeDistance(const Vec3& p, const Vec3& normal, double constant);

}  // namespace bullet_fem
