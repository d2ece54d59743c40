// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/common/vector_targets.h"
#include "fem/elements/smoothed_elements.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/smoothed_pass.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/initial_stress-inl.h"
#include "fem/elements/smoothed_strain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// For processors without vector instructions.
template <class Real>
void passStrains(const SmoothedPass<Real>& pass, Range pieces)
{
    reference::findStrains(pass, pieces);
}

template <class Real>
void passForces(const SmoothedPass<Real>& pass, Range blocks)
{
    reference::findForces(pass, blocks);
}

#else

/// Strains with and without damping; updates the rotations.
template <class Real>
HWY_INLINE void strainsOf(const SmoothedPass<Real>& smoothed, int b, int lane, Symmetric<Real>& elastic,
                          Symmetric<Real>& damped)
{
    const ElementPass<Real>& pass = smoothed.m_elements;
    const ElementBlock<Real>& block = pass.m_elements->m_blocks[b];
    StagedEdges<double, width<Real>()> x;
    StagedEdges<Real> v;
    x.stage(block.m_node + lane, pass.m_x);
    v.stage(block.m_node + lane, pass.m_v);
    const DeformedLanes<Real> elements = {block, x, lane};
    const Matrix<Real> DmInverse = elements.DmInverse(), F = times(roundedEdges<Real>(elements), DmInverse);
    Quaternion* rotation = pass.m_rotation + b * kLanes + lane;
    Quaternions<Real> q = loadQuaternions(rotation, Real());
    polarRotations(&F, 1, &q);
    storeQuaternions(q, rotation);
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    storeMatrix(R, smoothed.m_warped[b].m_rotation, lane);
    elastic = strainInFrameOf(R, times(edgesMinusRotated(elements, q), DmInverse));
    const Symmetric<Real> rate = strainInFrameOf(R, times(v.load(), DmInverse));
    damped = combined<Real>(number<Real>(pass.m_damping), rate, number<Real>(1), elastic);
}

template <class Real>
void passStrains(const SmoothedPass<Real>& pass, Range pieces)
{
    constexpr int kVectors = kLanes / width<Real>();
    const ElementBlocks<Real>& elements = *pass.m_elements.m_elements;
    for (int c = pieces.m_begin * kVectors; c < pieces.m_end * kVectors; ++c)
    {
        const PatchColumn column = patchColumn<Real>(elements.m_groups, c);
        Symmetric<Real> elastic[ElementPatches::kMax], damped[ElementPatches::kMax];
        Vector<Real> theta = hn::Zero(Lanes<Real>()), dampedTheta = theta;
        for (int k = 0; k < column.m_size; ++k)
        {
            const int b = column.m_block + k;
            strainsOf(pass, b, column.m_lane, elastic[k], damped[k]);
            const Vector<Real> share = hn::Load(Lanes<Real>(), elements.m_share[b].m_lane + column.m_lane);
            theta = hn::MulAdd(share, trace(elastic[k]), theta);
            dampedTheta = hn::MulAdd(share, trace(damped[k]), dampedTheta);
        }
        for (int k = 0; k < column.m_size; ++k)
        {
            storeQuads<Real>(elastic[k], theta, pass.m_elastic.m_element[column.m_block + k], column.m_lane);
            storeQuads<Real>(damped[k], dampedTheta, pass.m_damped.m_element[column.m_block + k], column.m_lane);
        }
    }
}

template <class Real>
HWY_INLINE Symmetric<Real> plus(const Symmetric<Real>& A, const Symmetric<Real>& B)
{
    return {A.xx + B.xx, A.yy + B.yy, A.zz + B.zz, A.yz + B.yz, A.xz + B.xz, A.xy + B.xy};
}

template <class Real>
HWY_INLINE void passForces(const SmoothedPass<Real>& pass, int b, int lane)
{
    const Lanes<Real> d;
    const ElementBlocks<Real>& elements = *pass.m_elements.m_elements;
    const Vector<Real> lambda = loadLambda(elements, b, lane), mu = loadMu(elements, b, lane);
    StagedStrains<Real> smoothed[2];
    smoothed[0].stage(*pass.m_smoothing, pass.m_elastic, b, lane);
    smoothed[1].stage(*pass.m_smoothing, pass.m_damped, b, lane);
    Vector<Real> theta, dampedTheta;
    const auto &own = pass.m_elastic.m_element[b].m_quad, &ownDamped = pass.m_damped.m_element[b].m_quad;
    const Symmetric<Real> strain = loadQuads<Real>(own[0][lane], own[1][lane], theta);
    loadQuads<Real>(ownDamped[0][lane], ownDamped[1][lane], dampedTheta);

    Symmetric<Real> stress = smoothedStress<Real>(lambda, mu, smoothed[0].load(), theta);
    Symmetric<Real> damped = smoothedStress<Real>(lambda, mu, smoothed[1].load(), dampedTheta);
    if (pass.m_elements.m_initialStress)
    {
        const auto& s = pass.m_elements.m_initialStress[b].m_entry;
        const Symmetric<Real> initial = {hn::Load(d, s[0] + lane), hn::Load(d, s[1] + lane), hn::Load(d, s[2] + lane),
                                         hn::Load(d, s[3] + lane), hn::Load(d, s[4] + lane), hn::Load(d, s[5] + lane)};
        stress = plus(stress, initial);
        damped = plus(damped, initial);
    }
    Vector<Real> w[3];
    balanceTorque(strain, stress, w);
    const Matrix<Real> P = {{{damped.xx, damped.xy - w[2], damped.xz + w[1]},
                             {damped.xy + w[2], damped.yy, damped.yz - w[0]},
                             {damped.xz - w[1], damped.yz + w[0], damped.zz}}};
    const Matrix<Real> R = loadMatrix(pass.m_warped[b].m_rotation, lane);
    const Matrix<Real> minusGradients = timesTranspose(P, loadMatrix(elements.m_blocks[b].m_DmInverse, lane));
    Matrix<Real> f = times(R, minusGradients);
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) f.m[k / 3][k % 3] = hn::Neg(f.m[k / 3][k % 3]);
    storeCorners(f, pass.m_elements.m_force[b], lane);

    const Symmetric<Real> T = tensionOf(pass.m_elements.m_tensionFactor, stress);
    const Vector<Real> entries[6] = {T.xx, T.yy, T.zz, T.yz, T.xz, T.xy};
    HWY_UNROLL(6)
    for (int k = 0; k < 6; ++k) hn::Store(entries[k], d, pass.m_warped[b].m_tension[k] + lane);
}

template <class Real>
void passForces(const SmoothedPass<Real>& pass, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; lane += width<Real>()) passForces(pass, b, lane);
}

#endif

void smoothedPassStrainsFloat(const SmoothedPass<float>& pass, Range pieces)
{
    passStrains(pass, pieces);
}

void smoothedPassStrainsDouble(const SmoothedPass<double>& pass, Range pieces)
{
    passStrains(pass, pieces);
}

void smoothedPassForcesFloat(const SmoothedPass<float>& pass, Range blocks)
{
    passForces(pass, blocks);
}

void smoothedPassForcesDouble(const SmoothedPass<double>& pass, Range blocks)
{
    passForces(pass, blocks);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(smoothedPassStrainsFloat);
HWY_EXPORT(smoothedPassStrainsDouble);
HWY_EXPORT(smoothedPassForcesFloat);
HWY_EXPORT(smoothedPassForcesDouble);

template <>
void findStrains(const SmoothedPass<float>& pass, Range pieces)
{
    HWY_DYNAMIC_DISPATCH(smoothedPassStrainsFloat)(pass, pieces);
}

template <>
void findStrains(const SmoothedPass<double>& pass, Range pieces)
{
    HWY_DYNAMIC_DISPATCH(smoothedPassStrainsDouble)(pass, pieces);
}

template <>
void findForces(const SmoothedPass<float>& pass, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(smoothedPassForcesFloat)(pass, blocks);
}

template <>
void findForces(const SmoothedPass<double>& pass, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(smoothedPassForcesDouble)(pass, blocks);
}

}  // namespace bullet_fem
#endif
