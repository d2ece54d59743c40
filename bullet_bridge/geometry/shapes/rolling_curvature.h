// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/shapes/shape_distance.h"

namespace bullet_fem
{

/// Curvature of a convex shape along the direction in which it rolls [1/m], at the point where its unit normal is
/// `normal`, with the angular velocity `spin` [rad/s]. A sphere's does not depend on its spin. 0 for shapes that do not
/// roll: flat or concave ones, polyhedra with ten facets or fewer around the axis of rolling, and shapes that are long
/// across it. Never allocates.
double rollingCurvature(const ShapeLeaf& leaf, const Vec3& normal, const Vec3& spin);

}  // namespace bullet_fem
