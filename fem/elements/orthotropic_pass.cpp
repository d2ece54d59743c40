// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/common/vector_targets.h"
#include "fem/elements/orthotropic_elements.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/orthotropic_pass.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/orthotropic_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// For processors without vector instructions.
template <class Real>
void passOrthotropic(const OrthotropicPass<Real>& pass, Range blocks)
{
    reference::runOrthotropicPass(pass, blocks);
}

#else

/// Updates the rotations of a vector of elements to the present positions and returns them.
template <class Real>
HWY_INLINE Quaternions<Real> turnedLanes(const ElementPass<Real>& pass, const DeformedLanes<Real>& elements,
                                         Quaternion* rotation)
{
    Quaternions<Real> q = loadQuaternions(rotation, Real());
    if (pass.m_isRotated) return q;
    const Matrix<Real> F = times(roundedEdges<Real>(elements), elements.DmInverse());
    polarRotations(&F, 1, &q);
    storeQuaternions(q, rotation);
    return q;
}

template <class Real>
HWY_INLINE void passOrthotropicLanes(const OrthotropicPass<Real>& pass, int b, int lane,
                                     const StagedEdges<double, width<Real>()>& x, const Matrix<Real>& velocityEdges)
{
    const ElementPass<Real>& plain = pass.m_elements;
    const DeformedLanes<Real> elements = {plain.m_elements->m_blocks[b], x, lane};
    const StiffnessBlock<Real>& D = plain.m_elements->m_stiffness[b];
    const Matrix<Real> DmInverse = elements.DmInverse();
    const Quaternions<Real> q = turnedLanes(plain, elements, plain.m_rotation + b * kLanes + lane);
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    const Symmetric<Real> strain = strainInFrameOf(R, times(edgesMinusRotated(elements, q), DmInverse));
    StretchLanes<Real> lanes;
    lanes.find(strain);
    const Matrix<Real> rate = inFrameOf(R, times(velocityEdges, DmInverse));
    const ElementBlock<Real>& block = plain.m_elements->m_blocks[b];
    const Vector<Real> lambda = hn::Load(Lanes<Real>(), block.m_lambdaVolume + lane);
    const Vector<Real> mu = hn::Load(Lanes<Real>(), block.m_muVolume + lane);
    const Vector<Real> one = number<Real>(1), minusOne = number<Real>(-1);
    Symmetric<Real> rest = stiffnessTimes(D, lane, strain);
    if (plain.m_initialStress)
        rest = combined<Real>(one, loadSymmetricRows(plain.m_initialStress[b].m_entry, lane), one, rest);
    const Symmetric<Real> damped = combined<Real>(number<Real>(plain.m_damping), doubledPart(rate), one, strain);
    const Symmetric<Real> minusStress = hooke<Real>(hn::Neg(lambda), hn::Neg(mu), damped);
    const Symmetric<Real> viscousRest = stiffnessTimes(D, lane, lanes.change(rate));
    const Symmetric<Real> minusRest = combined<Real>(number<Real>(-plain.m_damping), viscousRest, minusOne, rest);
    const Matrix<Real> P = lanes.balanced(minusStress, minusRest);
    storeCorners(times(R, timesTranspose(P, DmInverse)), plain.m_force[b], lane);

    OrthotropicBlock<Real>& out = pass.m_warped[b];
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) hn::Store(R.m[k / 3][k % 3], Lanes<Real>(), out.m_rotation[k] + lane);
    const Symmetric<Real> stress = combined<Real>(one, hooke<Real>(lambda, mu, strain), one, rest);
    storeSymmetricRows(tensionOf(plain.m_tensionFactor, stress), out.m_tension, lane);
    storeSymmetricRows(lanes.m_stretch, out.m_stretch, lane);
    storeSymmetricRows(lanes.m_spin, out.m_spin, lane);
}

template <class Real>
void passOrthotropic(const OrthotropicPass<Real>& pass, Range blocks)
{
    const ElementPass<Real>& plain = pass.m_elements;
    StagedEdges<double, width<Real>()> x[2];
    StagedEdges<Real> v[2];
    const auto stage = [&](int b, int lane, int slot)
    {
        x[slot].stage(plain.m_elements->m_blocks[b].m_node + lane, plain.m_x);
        v[slot].stage(plain.m_elements->m_blocks[b].m_node + lane, plain.m_v);
    };
    const auto compute = [&](int b, int lane, int slot)
    { passOrthotropicLanes(pass, b, lane, x[slot], v[slot].load()); };
    forEachVector<Real>(blocks, stage, compute);
}

#endif

void orthotropicPassFloat(const OrthotropicPass<float>& pass, Range blocks)
{
    passOrthotropic(pass, blocks);
}

void orthotropicPassDouble(const OrthotropicPass<double>& pass, Range blocks)
{
    passOrthotropic(pass, blocks);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(orthotropicPassFloat);
HWY_EXPORT(orthotropicPassDouble);

template <>
void runOrthotropicPass(const OrthotropicPass<float>& pass, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(orthotropicPassFloat)(pass, blocks);
}

template <>
void runOrthotropicPass(const OrthotropicPass<double>& pass, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(orthotropicPassDouble)(pass, blocks);
}

}  // namespace bullet_fem
#endif
