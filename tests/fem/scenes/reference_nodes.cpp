// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <cstddef>

#include "fem/common/rotation.h"
#include "fem/elements/robust_rotations.h"
#include "fem/scenes/reference_elements.h"

namespace bullet_fem
{
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
