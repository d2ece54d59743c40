// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A rotation q = (x, y, z, w), w the cosine of half the angle, |q| = 1 to rounding; q and -q are the same.
template <class Real>
struct alignas(4 * sizeof(Real)) BasicQuaternion
{
    Real x = 0;  ///< sine of half the angle times the axis
    Real y = 0;  ///< likewise
    Real z = 0;  ///< likewise
    Real w = 1;  ///< cosine of half the angle
};

using Quaternion = BasicQuaternion<float>;  ///< as bodies keep them: the start of the next iteration

/// R of a quaternion of any length but zero; orthogonal to rounding of double precision.
template <class Real>
BULLETFEM_API Mat3 toMatrix(const BasicQuaternion<Real>& q);

/// One of the two quaternions of a rotation R.
BULLETFEM_API BasicQuaternion<double> toQuaternion(const Mat3& R);

/// Rounds to single precision.
inline Quaternion rounded(const BasicQuaternion<double>& q)
{
    return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
}

}  // namespace bullet_fem
