// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btVector3.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Converts from Bullet's vector to double precision.
inline Vec3 vec3(const btVector3& v)
{
    return {double(v.x()), double(v.y()), double(v.z())};
}

/// Converts to Bullet's vector and precision.
inline btVector3 bulletVector(const Vec3& v)
{
    return {btScalar(v.x), btScalar(v.y), btScalar(v.z)};
}

}  // namespace bullet_fem
