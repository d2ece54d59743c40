// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/shapes/shape_distance.h"

class btSdfCollisionShape;

namespace bullet_fem
{

/// The shape as Bullet's signed distance field, or null. Its type number is that of custom concave shapes, too.
const btSdfCollisionShape* fieldOf(const btCollisionShape& shape);

/// True if the field was loaded: somewhere on a coarse grid over its domain it has a value.
bool isLoaded(const btSdfCollisionShape& field);

/// True of shapes with an inside: convex ones and fields. Their distances are asked of points, edges and triangles.
bool isSolid(const btCollisionShape& shape);

/// True of soups of two-sided triangles: concave shapes but planes and fields.
bool isSheet(const btCollisionShape& shape);

/// Signed distance of a point in the field's frame, less its margin, with the normal in that frame. The field is the
/// solid's distance in its domain, a box, and nothing of the solid is outside; beyond the box the gap is a lower bound,
/// from what is known at its nearest point. Bullet ignores the scaling of fields, and so it is here. False, and
/// `distance` untouched, where the field has no value, or it is farther than maxDistance [m].
bool pointFieldDistance(const btSdfCollisionShape& field, const Vec3& point, double maxDistance,
                        SurfaceDistance& distance);

/// The point of a triangle, likewise in the field's frame, where the field is least nearby: down its gradient along the
/// triangle from the best of corners, middles and centre [Macklin et al. 2020], to 1e-3 of the longest edge.
bool triangleFieldDistance(const btSdfCollisionShape& field, const std::array<Vec3, 3>& triangle, double maxDistance,
                           SurfaceDistance& distance);

}  // namespace bullet_fem
