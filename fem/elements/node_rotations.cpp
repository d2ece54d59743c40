// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/node_rotations.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/node_rotations.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/robust_rotations.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using D4 = hn::CappedTag<float, 4>;  // one quaternion, or a component of it

/// Row-major rotation matrix of a quaternion of squared length n > 0.
HWY_INLINE NodeRotation rotationOf(const float* q, float n)
{
    const float s = 2 / n, x = q[0], y = q[1], z = q[2], w = q[3];
    const float sx = s * x, sy = s * y, sz = s * z;
    const float xx = sx * x, yy = sy * y, zz = sz * z, xy = sx * y, xz = sx * z, yz = sy * z;
    const float wx = sx * w, wy = sy * w, wz = sz * w;
    return {{1 - (yy + zz), xy - wz, xz + wy, xy + wz, 1 - (xx + zz), yz - wx, xz - wy, yz + wx, 1 - (xx + yy)}};
}

/// The plain sum, if it is nearly as long as the sum of all |V_e q_e|: a wrong sign then belongs to a sliver, and
/// shortens the sum but hardly rotates it.
HWY_INLINE NodeRotation averageAt(const NodeRotations& rotations, int node)
{
    const D4 d;
    const int* corner = rotations.m_nodes->m_corner.data() + rotations.m_nodes->m_start[node];
    const int* end = rotations.m_nodes->m_corner.data() + rotations.m_nodes->m_start[node + 1];
    if (corner == end) return {};  // a loose node
    HWY_ALIGN float q[4];
    for (int c = 0; c < 4; c += static_cast<int>(hn::MaxLanes(d)))
    {
        // Two partial sums make additions independent.
        hn::Vec<D4> sums[2] = {hn::Zero(d), hn::Zero(d)};
        const auto add = [&](int k, int e)
        {
            const float V = rotations.m_nodes->m_volume[e];
            sums[k] = hn::MulAdd(hn::Set(d, V), hn::Load(d, &rotations.m_rotation[e].x + c), sums[k]);
        };
        const int* k = corner;
        for (; k + 1 < end; k += 2)
        {
            add(0, NodeCorners::element(k[0]));
            add(1, NodeCorners::element(k[1]));
        }
        if (k < end) add(0, NodeCorners::element(k[0]));
        hn::Store(hn::Add(sums[0], sums[1]), d, q + c);
    }
    const float squaredLength = (q[0] * q[0] + q[2] * q[2]) + (q[1] * q[1] + q[3] * q[3]);
    if (!(squaredLength >= minSquaredLength(*rotations.m_nodes, node))) return robustAverage(rotations, node);
    return rotationOf(q, squaredLength);
}

void averageOverNodes(const NodeRotations& rotations, Range nodes)
{
    for (int i = nodes.m_begin; i < nodes.m_end; ++i) rotations.m_out[i] = averageAt(rotations, i);
}

/// Uses sums of V q q^T, because the entries of R are sums of products of two components of q.
Mat3 sumOverBlocks(const NodeCorners& nodes, const Quaternion* rotation, Range blocks)
{
    const hn::CappedTag<double, kLanes> d;
    const hn::Rebind<float, decltype(d)> single;
    constexpr int kN = static_cast<int>(hn::MaxLanes(hn::CappedTag<double, kLanes>()));
    hn::Vec<decltype(d)> sum[10];
    for (auto& s : sum) s = hn::Zero(d);
    for (int e = blocks.m_begin * kLanes; e < blocks.m_end * kLanes; e += kN)
    {
        hn::Vec<decltype(single)> component[4];
        hn::LoadInterleaved4(single, &rotation[e].x, component[0], component[1], component[2], component[3]);
        const auto V = hn::PromoteTo(d, hn::Load(single, nodes.m_volume.data() + e));
        hn::Vec<decltype(d)> q[4];
        HWY_UNROLL(4)
        for (int i = 0; i < 4; ++i) q[i] = hn::PromoteTo(d, component[i]);
        int k = 0;
        HWY_UNROLL(4)
        for (int i = 0; i < 4; ++i)
        {
            const auto Vq = hn::Mul(V, q[i]);
            HWY_UNROLL(4)
            for (int j = i; j < 4; ++j, ++k) sum[k] = hn::MulAdd(Vq, q[j], sum[k]);
        }
    }
    double s[10];
    for (int k = 0; k < 10; ++k) s[k] = hn::GetLane(hn::SumOfLanes(d, sum[k]));
    const double xx = s[0], xy = s[1], xz = s[2], xw = s[3], yy = s[4], yz = s[5], yw = s[6], zz = s[7], zw = s[8],
                 ww = s[9];
    return {{{ww + xx - yy - zz, 2 * (xy - zw), 2 * (xz + yw)},
             {2 * (xy + zw), ww - xx + yy - zz, 2 * (yz - xw)},
             {2 * (xz - yw), 2 * (yz + xw), ww - xx - yy + zz}}};
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(averageOverNodes, void averageRotations(const NodeRotations& rotations, Range nodes), rotations, nodes)
BULLETFEM_EXPORT(sumOverBlocks, Mat3 sumRotations(const NodeCorners& nodes, const Quaternion* rotation, Range blocks),
                 nodes, rotation, blocks)

}  // namespace bullet_fem
#endif
