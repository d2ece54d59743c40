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

void RotateOut(const BatchWarp& warp, const PerBatch& scale, BodyVectors out)
{
    forEachNode(warp.m_nodes,
                [&](int node, int lane)
                {
                    F R[9], q[3];
                    loadFloats(DF(), warp.m_rotation, node, lane, R);
                    loadFloats(DF(), warp.m_factorVector, warp.m_position[node], lane, q);
                    const auto row = [&](int c)
                    { return hn::PromoteTo(D(), R[3 * c] * q[0] + R[3 * c + 1] * q[1] + R[3 * c + 2] * q[2]); };
                    store3(V3{row(0), row(1), row(2)} * valuesOf(scale, lane), out + place(node, lane));
                });
}

HWY_INLINE V3 set3(const Vec3& v)
{
    return {hn::Set(D(), v.x), hn::Set(D(), v.y), hn::Set(D(), v.z)};
}

HWY_INLINE V3 loadFactorEntry(const float* y, int node, int lane)
{
    F q[3];
    loadFloats(DF(), y, node, lane, q);
    return {hn::PromoteTo(D(), q[0]), hn::PromoteTo(D(), q[1]), hn::PromoteTo(D(), q[2])};
}

HWY_INLINE void storeFactorEntry(const V3& v, int node, int lane, float* y)
{
    const F q[3] = {hn::DemoteTo(DF(), v.x), hn::DemoteTo(DF(), v.y), hn::DemoteTo(DF(), v.z)};
    storeFloats(DF(), q, node, lane, y);
}

/// The rigid motion of a component with these momenta.
struct RestMotion
{
    V3 m_linear, m_angular;
};
HWY_INLINE RestMotion restMotionOf(const RestModes& modes, const V3& linear, const V3& angular)
{
    const RestModes::Component& component = modes.components().front();
    const Mat3& I = component.m_inverseInertia;
    const auto row = [&](int k) { return dot(set3({I(k, 0), I(k, 1), I(k, 2)}), angular); };
    return {linear * hn::Set(D(), component.m_inverseMass), {row(0), row(1), row(2)}};
}

HWY_INLINE void storeMotion(const RestMotion& motion, int lane, BatchMotions& motions)
{
    const V linear[3] = {motion.m_linear.x, motion.m_linear.y, motion.m_linear.z};
    const V angular[3] = {motion.m_angular.x, motion.m_angular.y, motion.m_angular.z};
    for (int c = 0; c < 3; ++c)
    {
        storeValues(linear[c], lane, motions.m_linear[c]);
        storeValues(angular[c], lane, motions.m_angular[c]);
    }
}

HWY_INLINE V3 valuesOf3(const PerBatch3& values, int lane)
{
    return {valuesOf(values[0], lane), valuesOf(values[1], lane), valuesOf(values[2], lane)};
}

void RemoveRestImpulses(const RestModes& modes, float* factorVector, BatchMotions& motions)
{
    const int count = static_cast<int>(modes.nodes().size());
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V zero = hn::Zero(D());
        V3 linear = {zero, zero, zero}, angular = linear;
        for (int k = 0; k < count; ++k)
        {
            const V3 impulse = loadFactorEntry(factorVector, k, lane);
            linear = linear + impulse;
            angular = angular + cross(set3(modes.nodes()[k].m_lever), impulse);
        }
        const RestMotion motion = restMotionOf(modes, linear, angular);
        storeMotion(motion, lane, motions);
        for (int k = 0; k < count; ++k)
        {
            const V3 velocity = motion.m_linear + cross(motion.m_angular, set3(modes.nodes()[k].m_lever));
            const V3 rigid = velocity * hn::Set(D(), modes.nodes()[k].m_mass);
            storeFactorEntry(loadFactorEntry(factorVector, k, lane) - rigid, k, lane, factorVector);
        }
    }
}

void ReplaceRestMotions(const RestModes& modes, const BatchMotions& motions, float* factorVector)
{
    const int count = static_cast<int>(modes.nodes().size());
    const V softness = hn::Set(D(), modes.components().front().m_softness);
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V zero = hn::Zero(D());
        V3 linear = {zero, zero, zero}, angular = linear;
        for (int k = 0; k < count; ++k)
        {
            const V3 momentum = loadFactorEntry(factorVector, k, lane) * hn::Set(D(), modes.nodes()[k].m_mass);
            linear = linear + momentum;
            angular = angular + cross(set3(modes.nodes()[k].m_lever), momentum);
        }
        const RestMotion found = restMotionOf(modes, linear, angular);
        linear = valuesOf3(motions.m_linear, lane) * softness - found.m_linear;
        angular = valuesOf3(motions.m_angular, lane) * softness - found.m_angular;
        for (int k = 0; k < count; ++k)
        {
            const V3 velocity = linear + cross(angular, set3(modes.nodes()[k].m_lever));
            storeFactorEntry(loadFactorEntry(factorVector, k, lane) + velocity, k, lane, factorVector);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(AverageLanes, void averageRotations(const BatchNodeRotations& rotations), rotations)
BULLETFEM_EXPORT(RotateIn, PerBatch rotateIn(const BatchWarp& warp, ConstBodyVectors in), warp, in)
BULLETFEM_EXPORT(RotateOut, void rotateOut(const BatchWarp& warp, const PerBatch& scale, BodyVectors out), warp, scale,
                 out)
BULLETFEM_EXPORT(RemoveRestImpulses,
                 void removeRestImpulses(const RestModes& modes, float* factorVector, BatchMotions& motions), modes,
                 factorVector, motions)
BULLETFEM_EXPORT(ReplaceRestMotions,
                 void replaceRestMotions(const RestModes& modes, const BatchMotions& motions, float* factorVector),
                 modes, motions, factorVector)

}  // namespace bullet_fem
#endif
