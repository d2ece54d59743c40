// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/element_strains.h"

#include "bullet_fem/fem/common/symmetric.h"
#include "fem/common/rotation.h"
#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/element_strains.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/element_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// For processors without vector instructions.
template <class Real>
void strainBlocks(const ElementStrains<Real>& strains, Range blocks)
{
    reference::runElementStrains(strains, blocks);
}

#else

template <class Real>
void strainBlocks(const ElementStrains<Real>& strains, Range blocks)
{
    constexpr int kN = width<Real>();
    const Lanes<Real> d;
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; lane += kN)
        {
            const ElementBlock<Real>& block = strains.m_elements->m_blocks[b];
            StagedEdges<double, kN> staged;
            staged.stage(block.m_node + lane, strains.m_x);
            const DeformedLanes<Real> elements = {block, staged, lane};
            Quaternion* rotation = strains.m_rotation + b * kLanes + lane;
            const Matrix<Real> F = times(roundedEdges<Real>(elements), elements.DmInverse());
            Quaternions<Real> q = loadQuaternions(rotation, Real());
            polarRotations(&F, 1, &q);
            storeQuaternions(q, rotation);
            const Symmetric<Real> E = strainInFrameOf(toMatrix(q, number<Real>(2)),
                                                      times(edgesMinusRotated(elements, q), elements.DmInverse()));
            const Vector<Real> half = number<Real>(0.5);
            const Vector<Real> entries[6] = {E.xx, E.yy, E.zz, half * E.yz, half * E.xz, half * E.xy};
            HWY_UNROLL(6)
            for (int k = 0; k < 6; ++k) hn::Store(entries[k], d, strains.m_strain[b].m_entry[k] + lane);
        }
}

#endif

void elementStrainsFloat(const ElementStrains<float>& strains, Range blocks)
{
    strainBlocks(strains, blocks);
}

void elementStrainsDouble(const ElementStrains<double>& strains, Range blocks)
{
    strainBlocks(strains, blocks);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(elementStrainsFloat);
HWY_EXPORT(elementStrainsDouble);

template <>
void runElementStrains(const ElementStrains<float>& strains, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(elementStrainsFloat)(strains, blocks);
}

template <>
void runElementStrains(const ElementStrains<double>& strains, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(elementStrainsDouble)(strains, blocks);
}

namespace reference
{

template <class Real>
void runElementStrains(const ElementStrains<Real>& strains, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            const ElementBlock<Real>& block = strains.m_elements->m_blocks[b];
            Mat3 DmInverse, Dm;
            for (int k = 0; k < 9; ++k)
            {
                DmInverse(k / 3, k % 3) = block.m_DmInverse[k][lane];
                Dm(k / 3, k % 3) = block.m_Dm[k][lane];
            }
            const std::int32_t* node = block.m_node[lane];
            const auto edge = [&](int a)
            {
                const PaddedVec3 &to = strains.m_x[node[a]], &from = strains.m_x[node[0]];
                return Vec3{to.x - from.x, to.y - from.y, to.z - from.z};
            };
            const Mat3 Ds = Mat3::fromColumns(edge(1), edge(2), edge(3));
            Quaternion& q = strains.m_rotation[b * kLanes + lane];
            const Mat3 R = polarRotation(Ds * DmInverse, toMatrix(q));
            q = rounded(toQuaternion(R));
            const SymmetricTensor E = symmetricPart(transposeTimes(R, (Ds - R * Dm) * DmInverse));
            const double entries[6] = {E.xx, E.yy, E.zz, E.yz, E.xz, E.xy};
            for (int k = 0; k < 6; ++k) strains.m_strain[b].m_entry[k][lane] = static_cast<Real>(entries[k]);
        }
}

template void runElementStrains(const ElementStrains<float>&, Range);
template void runElementStrains(const ElementStrains<double>&, Range);

}  // namespace reference
}  // namespace bullet_fem
#endif
