// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

#include "bullet_fem/fem/common/vec3.h"

class btCollisionShape;
class btTransform;

namespace bullet_fem
{

/// A hash of the part of a shape at `transform` that a body in the world box from `low` to `high` [m] can be in contact
/// with; used to detect changes. Convex shapes are hashed completely, by bounds, margin, scaling, and corners or eight
/// support points; compounds by the children that overlap the box; meshes and heightfields by the triangles in it. It
/// depends on values, not on addresses: equal shapes have equal hashes. Shapes that collectShapeLeaves() omits are
/// hashed by their type alone. An invalid box contains nothing. Never allocates.
std::uint64_t markOfShape(const btCollisionShape& shape, const btTransform& transform, const Vec3& low,
                          const Vec3& high);

}  // namespace bullet_fem
