// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

#include "bullet_fem/fem/common/vec3.h"

class btCollisionShape;
class btTransform;

namespace bullet_fem
{

/// A number that another shape has not, for comparison: of what a body in the world box from `low` to `high` [m] can
/// touch of a shape that stands at `transform`. Of convex shapes it is all, told by bounds, margin, scaling, and
/// corners or eight extreme points; of compounds, children that reach into the box; of meshes and heightfields, the
/// triangles there. It knows values, not addresses: an equal shape elsewhere has the same mark. Shapes that
/// collectShapeLeaves leaves out are told by their type alone; a box that is none holds nothing. Never allocates.
std::uint64_t markOfShape(const btCollisionShape& shape, const btTransform& transform, const Vec3& low,
                          const Vec3& high);

}  // namespace bullet_fem
