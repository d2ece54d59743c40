// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/elements/robust_polar.h"

#include <cmath>

#include "fem/common/rotation.h"

namespace bullet_fem
{

template <class Real>
BasicQuaternion<Real> robustPolar(const Real (*F)[kLanes], int lane, const BasicQuaternion<Real>& guess)
{
    Mat3 A;
    for (int k = 0; k < 9; ++k) A(k / 3, k % 3) = F[k][lane];
    if (!std::isfinite(squaredNorm(A))) return guess;
    const BasicQuaternion<double> q = toQuaternion(polarRotation(A, toMatrix(guess)));
    const double s = q.x * guess.x + q.y * guess.y + q.z * guess.z + q.w * guess.w < 0 ? -1 : 1;
    return {static_cast<Real>(s * q.x), static_cast<Real>(s * q.y), static_cast<Real>(s * q.z),
            static_cast<Real>(s * q.w)};
}

template BasicQuaternion<float> robustPolar(const float (*)[kLanes], int, const BasicQuaternion<float>&);
template BasicQuaternion<double> robustPolar(const double (*)[kLanes], int, const BasicQuaternion<double>&);

}  // namespace bullet_fem
