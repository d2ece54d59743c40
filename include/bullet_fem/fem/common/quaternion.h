// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A rotation as a unit quaternion q = (x, y, z, w), |q| = 1 to rounding; q and -q are one rotation.
template <class Real>
struct alignas(4 * sizeof(Real)) BasicQuaternion
{
    Real x = 0;  ///< x component of sin(angle / 2) times the axis
    Real y = 0;  ///< y component of sin(angle / 2) times the axis
    Real z = 0;  ///< z component of sin(angle / 2) times the axis
    Real w = 1;  ///< cos(angle / 2)
};

using Quaternion = BasicQuaternion<float>;  ///< single precision, as body states store rotations for the next step

/// The rotation matrix of a quaternion of any nonzero length; orthogonal to rounding of double precision.
template <class Real>
BULLETFEM_API Mat3 toMatrix(const BasicQuaternion<Real>& q);

/// One of the two unit quaternions of a rotation matrix R.
BULLETFEM_API BasicQuaternion<double> toQuaternion(const Mat3& R);

/// Rounds the components to single precision.
inline Quaternion rounded(const BasicQuaternion<double>& q)
{
    return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
}

}  // namespace bullet_fem
