// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/batch/batch_algebra.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/batch/batch_rotations.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/batch/batch_vectors-inl.h"
#include "fem/elements/robust_rotations.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

using DF = hn::Rebind<float, D>;  // as many lanes as a vector of doubles
using F = hn::Vec<DF>;
using DWide = hn::CappedTag<float, kBatchWidth>;  // as many lanes as a vector of floats
using Wide = hn::Vec<DWide>;

/// Loads [item][Count][body], from body `lane` on.
template <class Tag, int Count>
HWY_INLINE void loadFloats(Tag tag, const float* from, int item, int lane, hn::Vec<Tag> (&v)[Count])
{
    const float* at = from + static_cast<std::size_t>(item) * Count * kBatchWidth + lane;
    HWY_UNROLL(9)
    for (int k = 0; k < Count; ++k) v[k] = hn::Load(tag, at + k * kBatchWidth);
}

template <class Tag, int Count>
HWY_INLINE void storeFloats(Tag tag, const hn::Vec<Tag> (&v)[Count], int item, int lane, float* to)
{
    float* at = to + static_cast<std::size_t>(item) * Count * kBatchWidth + lane;
    HWY_UNROLL(9)
    for (int k = 0; k < Count; ++k) hn::Store(v[k], tag, at + k * kBatchWidth);
}

/// Row-major rotation matrices of quaternions of squared length n > 0.
HWY_INLINE void rotationOf(const Wide (&q)[4], Wide n, Wide (&R)[9])
{
    const Wide one = hn::Set(DWide(), 1.f), s = hn::Set(DWide(), 2.f) / n;
    const Wide sx = s * q[0], sy = s * q[1], sz = s * q[2];
    const Wide xx = sx * q[0], yy = sy * q[1], zz = sz * q[2], xy = sx * q[1], xz = sx * q[2], yz = sy * q[2];
    const Wide wx = sx * q[3], wy = sy * q[3], wz = sz * q[3];
    const Wide entries[9] = {one - (yy + zz), xy - wz, xz + wy, xy + wz,        one - (xx + zz),
                             yz - wx,         xz - wy, yz + wx, one - (xx + yy)};
    for (int k = 0; k < 9; ++k) R[k] = entries[k];
}

/// Bit mask of the bodies that are not marked.
HWY_INLINE unsigned unmarked(hn::Mask<DWide> mask, int lane)
{
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(DWide(), mask, bits);
    const unsigned marked = bits[0] | static_cast<unsigned>(bits[1]) << 8, all = (1u << hn::MaxLanes(DWide())) - 1;
    return (~marked & all) << lane;
}

void AverageLanes(const BatchNodeRotations& rotations)
{
    const NodeCorners& nodes = *rotations.m_nodes;
    for (int i = 0; i < nodes.nodeCount(); ++i)
    {
        rotations.m_needsFallback[i] = 0;
        const Wide least = hn::Set(DWide(), minSquaredLength(nodes, i));
        for (int lane = 0; lane < kBatchWidth; lane += static_cast<int>(hn::MaxLanes(DWide())))
        {
            const Wide zero = hn::Zero(DWide());
            Wide q[4] = {zero, zero, zero, zero}, odd[4] = {zero, zero, zero, zero}, R[9];
            const auto add = [&](int corner, Wide(&sum)[4])
            {
                const int e = NodeCorners::element(corner);
                const Wide volume = hn::Set(DWide(), nodes.m_volume[e]);
                Wide turned[4];
                loadFloats(DWide(), rotations.m_elements, e, lane, turned);
                HWY_UNROLL(4)
                for (int c = 0; c < 4; ++c) sum[c] = hn::MulAdd(volume, turned[c], sum[c]);
            };
            const int* corner = nodes.m_corner.data() + nodes.m_start[i];
            const int* end = nodes.m_corner.data() + nodes.m_start[i + 1];
            for (; corner + 1 < end; corner += 2)
            {
                add(corner[0], q);
                add(corner[1], odd);
            }
            if (corner < end) add(*corner, q);
            HWY_UNROLL(4)
            for (int c = 0; c < 4; ++c) q[c] = q[c] + odd[c];
            const Wide squaredLength = (q[0] * q[0] + q[2] * q[2]) + (q[1] * q[1] + q[3] * q[3]);
            rotations.m_needsFallback[i] |= unmarked(squaredLength >= least, lane);
            rotationOf(q, squaredLength, R);
            storeFloats(DWide(), R, i, lane, rotations.m_out);
        }
    }
}

PerBatch RotateIn(const BatchWarp& warp, ConstBodyVectors in)
{
    PerBatch largest;
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V zero = hn::Zero(D()), one = hn::Set(D(), 1.0);
        V most = zero;
        for (int i = 0; i < warp.m_nodes; ++i)
        {
            const V3 r = load3(in + place(i, lane));
            most = hn::Max(hn::Max(most, hn::Abs(r.x)), hn::Max(hn::Abs(r.y), hn::Abs(r.z)));
        }
        storeValues(most, lane, largest);
        const V down = hn::IfThenElseZero(most > zero, one / most);
        for (int i = 0; i < warp.m_nodes; ++i)
        {
            const V3 r = load3(in + place(i, lane)) * down;
            const F x = hn::DemoteTo(DF(), r.x), y = hn::DemoteTo(DF(), r.y), z = hn::DemoteTo(DF(), r.z);
            F R[9], turned[3];
            loadFloats(DF(), warp.m_rotation, i, lane, R);
            HWY_UNROLL(3)
            for (int c = 0; c < 3; ++c) turned[c] = R[c] * x + R[3 + c] * y + R[6 + c] * z;
            storeFloats(DF(), turned, warp.m_position[i], lane, warp.m_factorVector);
        }
    }
    return largest;
}

PerBatch RotateOut(const BatchWarp& warp, const PerBatch& scale, ConstBodyVectors in, BodyVectors out)
{
    return sumOverNodes(warp.m_nodes,
                        [&](int node, int lane)
                        {
                            F R[9], q[3];
                            loadFloats(DF(), warp.m_rotation, node, lane, R);
                            loadFloats(DF(), warp.m_factorVector, warp.m_position[node], lane, q);
                            const auto row = [&](int c)
                            { return hn::PromoteTo(D(), R[3 * c] * q[0] + R[3 * c + 1] * q[1] + R[3 * c + 2] * q[2]); };
                            const V3 turned = V3{row(0), row(1), row(2)} * valuesOf(scale, lane);
                            store3(turned, out + place(node, lane));
                            return dot(load3(in + place(node, lane)), turned);
                        });
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(AverageLanes, void averageRotations(const BatchNodeRotations& rotations), rotations)
BULLETFEM_EXPORT(RotateIn, PerBatch rotateIn(const BatchWarp& warp, ConstBodyVectors in), warp, in)
BULLETFEM_EXPORT(RotateOut,
                 PerBatch rotateOut(const BatchWarp& warp, const PerBatch& scale, ConstBodyVectors in, BodyVectors out),
                 warp, scale, in, out)

}  // namespace bullet_fem
#endif
