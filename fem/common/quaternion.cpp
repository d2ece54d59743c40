// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/common/quaternion.h"

#include <cmath>

namespace bullet_fem
{

template <class Real>
Mat3 toMatrix(const BasicQuaternion<Real>& q)
{
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const double s = 2 / (x * x + y * y + z * z + w * w);
    return {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
             {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
             {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
}

template Mat3 toMatrix(const BasicQuaternion<float>&);
template Mat3 toMatrix(const BasicQuaternion<double>&);

// The columns are those of 4 q q^T; the one of the largest component is the most accurate.
BasicQuaternion<double> toQuaternion(const Mat3& R)
{
    const double xy = R(0, 1) + R(1, 0), xz = R(0, 2) + R(2, 0), yz = R(1, 2) + R(2, 1);
    const double wx = R(2, 1) - R(1, 2), wy = R(0, 2) - R(2, 0), wz = R(1, 0) - R(0, 1);
    const double a = R(0, 0), b = R(1, 1), c = R(2, 2);
    const double columns[4][4] = {{1 + a - b - c, xy, xz, wx},
                                  {xy, 1 - a + b - c, yz, wy},
                                  {xz, yz, 1 - a - b + c, wz},
                                  {wx, wy, wz, 1 + a + b + c}};
    int k = 0;
    for (int i = 1; i < 4; ++i)
        if (columns[i][i] > columns[k][k]) k = i;
    const double* q = columns[k];
    const double s = 1 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    return {s * q[0], s * q[1], s * q[2], s * q[3]};
}

}  // namespace bullet_fem
