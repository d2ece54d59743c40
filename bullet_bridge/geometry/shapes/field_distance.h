// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/shapes/shape_distance.h"

class btSdfCollisionShape;

namespace bullet_fem
{

/// The shape as Bullet's signed distance field, or null. Other custom concave shapes have its type number, too.
const btSdfCollisionShape* fieldOf(const btCollisionShape& shape);

/// True if the field is loaded: it has a value at some point of a coarse grid over its domain.
bool isLoaded(const btSdfCollisionShape& field);

/// True for shapes with an inside: convex shapes and fields. They are tested with points, edges and triangles.
bool isSolid(const btCollisionShape& shape);

/// True for sheets of two-sided triangles: concave shapes other than planes and fields.
bool isSheet(const btCollisionShape& shape);

/// Signed distance between a point and a field less its margin, with the normal, both in the field's frame. The domain
/// of the field is a box that contains the solid; outside of the box the gap is a lower bound from the value at the
/// nearest point of the box. Scaling of the field is ignored, as Bullet does. False, with `distance` unchanged, where
/// the field has no value, or if it exceeds maxDistance [m].
bool pointFieldDistance(const btSdfCollisionShape& field, const Vec3& point, double maxDistance,
                        SurfaceDistance& distance);

/// The deepest point of a triangle, in the field's frame: gradient descent on the triangle from the best of corners,
/// midpoints of edges and centroid [Macklin et al. 2020], to 1e-3 of the longest edge. Result and errors as for
/// pointFieldDistance().
bool triangleFieldDistance(const btSdfCollisionShape& field, const std::array<Vec3, 3>& triangle, double maxDistance,
                           SurfaceDistance& distance);

}  // namespace bullet_fem
