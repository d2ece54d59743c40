// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/elements/robust_rotations.h"

#include <cmath>

#include "fem/common/rotation.h"

namespace bullet_fem
{
namespace
{

NodeRotation rounded(const Mat3& R)
{
    NodeRotation result;
    for (int k = 0; k < 9; ++k) result.m[k] = static_cast<float>(R(k / 3, k % 3));
    return result;
}

/// polar(sum of V_e R_e); where the sum leaves it undetermined, the solution nearest to the first element's rotation.
NodeRotation polarOfSum(const NodeRotations& rotations, int node)
{
    const NodeCorners& nodes = *rotations.m_nodes;
    const int begin = nodes.m_start[node], end = nodes.m_start[node + 1];
    const Quaternion& first = rotations.m_rotation[NodeCorners::element(nodes.m_corner[begin])];
    Mat3 sum;
    for (int k = begin; k < end; ++k)
    {
        const int e = NodeCorners::element(nodes.m_corner[k]);
        sum += nodes.m_volume[e] * toMatrix(rotations.m_rotation[e]);
    }
    return rounded(polarRotation(sum, toMatrix(first)));
}

}  // namespace

NodeRotation robustAverage(const NodeRotations& rotations, int node)
{
    constexpr double kAlignedShareOfPlainSum = 0.7;
    const NodeCorners& nodes = *rotations.m_nodes;
    const int begin = nodes.m_start[node], end = nodes.m_start[node + 1];
    if (begin == end) return {};  // a loose node
    const Quaternion& p = rotations.m_rotation[NodeCorners::element(nodes.m_corner[begin])];
    BasicQuaternion<double> sum = {0, 0, 0, 0};
    double volume = 0;
    for (int k = begin; k < end; ++k)
    {
        const int e = NodeCorners::element(nodes.m_corner[k]);
        const Quaternion& q = rotations.m_rotation[e];
        const double V = std::copysign(nodes.m_volume[e], p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w);
        sum.x += V * q.x, sum.y += V * q.y, sum.z += V * q.z, sum.w += V * q.w;
        volume += std::fabs(V);
    }
    const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z + sum.w * sum.w);
    return length >= kAlignedShareOfPlainSum * volume ? rounded(toMatrix(sum)) : polarOfSum(rotations, node);
}
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
