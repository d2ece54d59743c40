// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btMatrix3x3.h"
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

/// Bullet's matrix in double.
inline Mat3 mat3(const btMatrix3x3& m)
{
    return Mat3::fromColumns(vec3(m.getColumn(0)), vec3(m.getColumn(1)), vec3(m.getColumn(2)));
}

/// A matrix in Bullet's precision.
inline btMatrix3x3 bulletMatrix(const Mat3& m)
{
    btMatrix3x3 result;
    for (int i = 0; i < 3; ++i) result[i] = {btScalar(m(i, 0)), btScalar(m(i, 1)), btScalar(m(i, 2))};
    return result;
}

}  // namespace bullet_fem
