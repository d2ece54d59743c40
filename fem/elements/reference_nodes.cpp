// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The node kernels in plain C++, in double precision: reference for tests of the vector kernels.
#include <cmath>
#include <cstddef>

#include "fem/common/rotation.h"
#include "fem/elements/node_sums.h"
#include "fem/elements/robust_average.h"

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

namespace reference
{

void averageRotations(const NodeRotations& rotations, Range nodes)
{
    for (int i = nodes.m_begin; i < nodes.m_end; ++i) rotations.m_out[i] = robustAverage(rotations, i);
}

Mat3 sumRotations(const NodeCorners& nodes, const Quaternion* rotation, Range blocks)
{
    Mat3 sum;
    for (int e = blocks.m_begin * kLanes; e < blocks.m_end * kLanes; ++e)
        sum += nodes.m_volume[e] * toMatrix(rotation[e]);
    return sum;
}

template <class Real>
void sumCorners(const NodeSums<Real>& sums, Range nodes)
{
    const NodeCorners& corners = *sums.m_nodes;
    for (int i = nodes.m_begin; i < nodes.m_end; ++i)
    {
        Vec3 sum;
        for (int k = corners.m_start[i]; k < corners.m_start[i + 1]; ++k)
        {
            const Real* v = &sums.m_corners->m_vector[0][0][0] + 4 * static_cast<std::ptrdiff_t>(corners.m_corner[k]);
            sum += Vec3{v[0], v[1], v[2]};
        }
        const PaddedVec3 p = sums.m_scale ? sums.m_p[i] : PaddedVec3();
        sums.m_out[i] = sum + (sums.m_scale ? sums.m_scale[i] * Vec3{p.x, p.y, p.z} : sums.m_out[i]);
    }
}

template void sumCorners(const NodeSums<float>&, Range);
template void sumCorners(const NodeSums<double>&, Range);

}  // namespace reference
}  // namespace bullet_fem
