// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/orthotropic_elements.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/orthotropic_elements.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/stretch_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

template <class Real>
HWY_INLINE void passOrthotropicLanes(const StretchPass<Real>& pass, int b, int lane,
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
        rest = combined<Real>(one, loadSymmetric(plain.m_initialStress[b].m_entry, lane), one, rest);
    const Symmetric<Real> damped = combined<Real>(number<Real>(plain.m_damping), doubledPart(rate), one, strain);
    const Symmetric<Real> minusStress = hooke<Real>(hn::Neg(lambda), hn::Neg(mu), damped);
    const Symmetric<Real> viscousRest = stiffnessTimes(D, lane, lanes.change(rate));
    const Symmetric<Real> minusRest = combined<Real>(number<Real>(-plain.m_damping), viscousRest, minusOne, rest);
    const Matrix<Real> P = lanes.balanced(minusStress, minusRest);
    storeCorners(times(R, timesTranspose(P, DmInverse)), plain.m_force[b], lane);

    StretchBlock<Real>& out = pass.m_warped[b];
    storeMatrix(R, out.m_rotation, lane);
    const Symmetric<Real> stress = combined<Real>(one, hooke<Real>(lambda, mu, strain), one, rest);
    storeSymmetric(tensionOf(plain.m_tensionFactor, stress), out.m_tension, lane);
    storeSymmetric(lanes.m_stretch, out.m_stretch, lane);
    storeSymmetric(lanes.m_spin, out.m_spin, lane);
}

template <class Real>
void passOrthotropic(const StretchPass<Real>& pass, Range blocks)
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

template <class Real>
void multiplyOrthotropic(const StretchProduct<Real>& product, Range blocks)
{
    const ElementProduct<Real>& plain = product.m_elements;
    const ElementBlocks<Real>& elements = *plain.m_elements;
    const Vector<Real> factor = number<Real>(plain.m_stiffnessFactor);
    StagedEdges<Real> edges[2];
    const auto stage = [&](int b, int lane, int slot)
    { edges[slot].stage(elements.m_blocks[b].m_node + lane, plain.m_p); };
    const auto compute = [&](int b, int lane, int slot)
    {
        const StretchBlock<Real>& warped = product.m_warped[b];
        const Matrix<Real> DmInverse = loadMatrix(elements.m_blocks[b].m_DmInverse, lane);
        const Matrix<Real> R = loadMatrix(warped.m_rotation, lane);
        const Matrix<Real> H = inFrameOf(R, times(edges[slot].load(), DmInverse));
        StretchLanes<Real> lanes;
        lanes.m_stretch = loadSymmetric(warped.m_stretch, lane);
        lanes.m_spin = loadSymmetric(warped.m_spin, lane);
        const ElementBlock<Real>& block = elements.m_blocks[b];
        const Vector<Real> lambda = factor * hn::Load(Lanes<Real>(), block.m_lambdaVolume + lane);
        const Vector<Real> mu = factor * hn::Load(Lanes<Real>(), block.m_muVolume + lane);
        const Symmetric<Real> change = times<Real>(lanes.change(H), factor);
        const Matrix<Real> P = plus(lanes.balanced(hooke<Real>(lambda, mu, doubledPart(H)),
                                                   stiffnessTimes(elements.m_stiffness[b], lane, change)),
                                    times(H, full(loadSymmetric(warped.m_tension, lane))));
        storeCorners(times(R, timesTranspose(P, DmInverse)), plain.m_out[b], lane);
    };
    forEachVector<Real>(blocks, stage, compute);
}

BULLETFEM_KERNEL(passOrthotropic, StretchPass)
BULLETFEM_KERNEL(multiplyOrthotropic, StretchProduct)

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT_KERNEL(passOrthotropic, StretchPass, runOrthotropicPass)
BULLETFEM_EXPORT_KERNEL(multiplyOrthotropic, StretchProduct, runOrthotropicProduct)

}  // namespace bullet_fem
#endif
