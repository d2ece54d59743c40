// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/smoothed_elements.h"

#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/smoothed_elements.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/initial_stress-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// Stores strains as quads of the elements from `lane` on.
template <class Real>
HWY_INLINE void storeQuads(const Symmetric<Real>& E, Vector<Real> theta, StrainQuads<Real>& out, int lane)
{
    const Lanes<Real> d;
    hn::StoreInterleaved4(E.xx, E.yy, E.zz, E.yz, d, out.m_quad[0][lane]);
    hn::StoreInterleaved4(E.xz, E.xy, theta, hn::Zero(d), d, out.m_quad[1][lane]);
}

/// Loads strains stored by storeQuads().
template <class Real>
HWY_INLINE Symmetric<Real> loadQuads(const Real* first, const Real* second, Vector<Real>& theta)
{
    const Lanes<Real> d;
    Symmetric<Real> E;
    Vector<Real> zero;
    hn::LoadInterleaved4(d, first, E.xx, E.yy, E.zz, E.yz);
    hn::LoadInterleaved4(d, second, E.xz, E.xy, theta, zero);
    return E;
}

/// The smoothed strains of as many elements as a vector has lanes, transferred to vectors via memory.
template <class Real>
struct StagedStrains
{
    HWY_ALIGN Real m_quad[2][width<Real>()][4];

    /// Elements of block b, from `lane` on.
    HWY_INLINE void stage(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, int b, int lane)
    {
        for (int i = 0; i < width<Real>(); ++i) stageLane(smoothing, strain, b, lane, i);
    }

    HWY_INLINE Symmetric<Real> load() const
    {
        Vector<Real> theta;
        return loadQuads<Real>(m_quad[0][0], m_quad[1][0], theta);
    }

private:
    HWY_INLINE void stageLane(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, int b, int lane,
                              int i)
    {
        const hn::CappedTag<Real, 4> d;
        const typename EdgeSmoothing<Real>::BlockShares& lanes = smoothing.m_lanes[b];
        const std::int32_t* domain = lanes.m_domain[lane + i];
        const auto own = hn::Set(d, lanes.m_own[lane + i]), share = hn::Set(d, lanes.m_ofDomain[lane + i]);
        HWY_UNROLL(2)
        for (int half = 0; half < 2; ++half)
            for (int c = 0; c < 4; c += static_cast<int>(hn::MaxLanes(d)))
            {
                const auto load = [&](int k) { return hn::Load(d, strain.m_domain[domain[k]].m_quad[half] + c); };
                const auto a = hn::Add(load(0), load(1)), b2 = hn::Add(load(2), load(3)), e = hn::Add(load(4), load(5));
                const auto sum = hn::Add(hn::Add(a, b2), e);
                const auto mine = hn::Mul(own, hn::Load(d, strain.m_element[b].m_quad[half][lane + i] + c));
                hn::Store(hn::MulAdd(share, sum, mine), d, m_quad[half][i] + c);
            }
    }
};

/// V (2 mu dev(s) + (lambda + 2/3 mu) theta I); the moduli include V.
template <class Real>
HWY_INLINE Symmetric<Real> smoothedStress(Vector<Real> lambda, Vector<Real> mu, const Symmetric<Real>& s,
                                          Vector<Real> theta)
{
    return hookeUnder<Real>(pressureInPatch<Real>(lambda, mu, trace(s), theta), mu, s);
}

template <class Real>
HWY_INLINE Vector<Real> loadLambda(const ElementBlocks<Real>& elements, int b, int lane)
{
    return hn::Load(Lanes<Real>(), elements.m_blocks[b].m_lambdaVolume + lane);
}

template <class Real>
HWY_INLINE Vector<Real> loadMu(const ElementBlocks<Real>& elements, int b, int lane)
{
    return hn::Load(Lanes<Real>(), elements.m_blocks[b].m_muVolume + lane);
}

template <class Real>
HWY_INLINE void averageOver(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, Range domains)
{
    const hn::CappedTag<Real, 4> d;
    constexpr int kN = static_cast<int>(hn::MaxLanes(d));
    const Real* quads = &strain.m_element->m_quad[0][0][0];
    for (int k = domains.m_begin; k < domains.m_end; ++k)
        for (int c = 0; c < 4; c += kN)
        {
            auto first = hn::Zero(d), second = hn::Zero(d);
            for (int i = smoothing.m_start[k]; i < smoothing.m_start[k + 1]; ++i)
            {
                const Real* quad = quads + 4 * static_cast<std::ptrdiff_t>(smoothing.m_place[i]) + c;
                const auto weight = hn::Set(d, smoothing.m_weight[i]);
                first = hn::MulAdd(weight, hn::Load(d, quad), first);
                second = hn::MulAdd(weight, hn::Load(d, quad + 4 * kLanes), second);
            }
            hn::Store(first, d, strain.m_domain[k].m_quad[0] + c);
            hn::Store(second, d, strain.m_domain[k].m_quad[1] + c);
        }
}

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
    if (smoothed.m_inelastic)
    {
        const Symmetric<Real> inelastic = loadSymmetric(smoothed.m_inelastic[b].m_entry, lane);
        elastic = combined<Real>(number<Real>(1), elastic, number<Real>(-1), withDoubling(inelastic));
    }
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
HWY_INLINE void passForces(const SmoothedPass<Real>& pass, int b, int lane)
{
    const ElementBlocks<Real>& elements = *pass.m_elements.m_elements;
    const Vector<Real> lambda = loadLambda(elements, b, lane), mu = loadMu(elements, b, lane);
    StagedStrains<Real> smoothed[2];
    smoothed[0].stage(*pass.m_smoothing, pass.m_elastic, b, lane);
    smoothed[1].stage(*pass.m_smoothing, pass.m_damped, b, lane);
    Vector<Real> theta, dampedTheta;
    const auto &own = pass.m_elastic.m_element[b].m_quad, &ownDamped = pass.m_damped.m_element[b].m_quad;
    Symmetric<Real> strain = loadQuads<Real>(own[0][lane], own[1][lane], theta);
    loadQuads<Real>(ownDamped[0][lane], ownDamped[1][lane], dampedTheta);

    Symmetric<Real> stress = smoothedStress<Real>(lambda, mu, smoothed[0].load(), theta);
    Symmetric<Real> damped = smoothedStress<Real>(lambda, mu, smoothed[1].load(), dampedTheta);
    if (pass.m_elements.m_initialStress)
    {
        const Symmetric<Real> initial = loadSymmetric(pass.m_elements.m_initialStress[b].m_entry, lane);
        stress = plus(stress, initial);
        damped = plus(damped, initial);
    }
    if (pass.m_inelastic) strain = plus(strain, withDoubling(loadSymmetric(pass.m_inelastic[b].m_entry, lane)));
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

    storeSymmetric(tensionOf(pass.m_elements.m_tensionFactor, stress), pass.m_warped[b].m_tension, lane);
}

template <class Real>
void passForces(const SmoothedPass<Real>& pass, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; lane += width<Real>()) passForces(pass, b, lane);
}

template <class Real>
void productStrains(const SmoothedProduct<Real>& product, Range pieces)
{
    const Lanes<Real> d;
    const ElementBlocks<Real>& elements = *product.m_elements.m_elements;
    StagedEdges<Real> edges[2][ElementPatches::kMax];
    Symmetric<Real> strain[ElementPatches::kMax];
    const auto stage = [&](const PatchColumn& column, int k, int slot)
    { edges[slot][k].stage(elements.m_blocks[column.m_block + k].m_node + column.m_lane, product.m_elements.m_p); };
    const auto compute = [&](const PatchColumn& column, int slot, const auto& other)
    {
        const int lane = column.m_lane;
        Vector<Real> theta = hn::Zero(d);
        for (int k = 0; k < column.m_size; ++k)
        {
            other(k);
            const int b = column.m_block + k;
            const SmoothedBlock<Real>& warped = product.m_warped[b];
            const Matrix<Real> H = times(edges[slot][k].load(), loadMatrix(elements.m_blocks[b].m_DmInverse, lane));
            strain[k] = strainInFrameOf(loadMatrix(warped.m_rotation, lane), H);
            const Matrix<Real> T = full(loadSymmetric(warped.m_tension, lane));
            storeMatrix(times(H, T), product.m_tension[b].m_entry, lane);
            theta = hn::MulAdd(hn::Load(d, elements.m_share[b].m_lane + lane), trace(strain[k]), theta);
        }
        for (int k = 0; k < column.m_size; ++k)
            storeQuads<Real>(strain[k], theta, product.m_strain.m_element[column.m_block + k], lane);
    };
    forEachColumn<Real>(elements.m_groups, pieces, stage, compute);
}

template <class Real>
void productForces(const SmoothedProduct<Real>& product, Range blocks)
{
    const Vector<Real> factor = number<Real>(product.m_elements.m_stiffnessFactor);
    const ElementBlocks<Real>& elements = *product.m_elements.m_elements;
    StagedStrains<Real> smoothed[2];
    const auto stage = [&](int b, int lane, int slot)
    { smoothed[slot].stage(*product.m_smoothing, product.m_strain, b, lane); };
    const auto compute = [&](int b, int lane, int slot)
    {
        Vector<Real> theta;
        const auto& own = product.m_strain.m_element[b].m_quad;
        loadQuads<Real>(own[0][lane], own[1][lane], theta);
        const Vector<Real> lambda = factor * loadLambda(elements, b, lane), mu = factor * loadMu(elements, b, lane);
        const Symmetric<Real> stress = smoothedStress<Real>(lambda, mu, smoothed[slot].load(), theta);
        const Matrix<Real> P = plus(times(loadMatrix(product.m_warped[b].m_rotation, lane), full(stress)),
                                    loadMatrix(product.m_tension[b].m_entry, lane));
        storeCorners(timesTranspose(P, loadMatrix(elements.m_blocks[b].m_DmInverse, lane)), product.m_elements.m_out[b],
                     lane);
    };
    forEachVector<Real>(blocks, stage, compute);
}

void averageFloat(const EdgeSmoothing<float>& smoothing, const SmoothedStrain<float>& strain, Range domains)
{
    averageOver(smoothing, strain, domains);
}

void averageDouble(const EdgeSmoothing<double>& smoothing, const SmoothedStrain<double>& strain, Range domains)
{
    averageOver(smoothing, strain, domains);
}
BULLETFEM_KERNEL(passStrains, SmoothedPass)
BULLETFEM_KERNEL(passForces, SmoothedPass)
BULLETFEM_KERNEL(productStrains, SmoothedProduct)
BULLETFEM_KERNEL(productForces, SmoothedProduct)

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT_KERNEL(passStrains, SmoothedPass, findStrains)
BULLETFEM_EXPORT_KERNEL(passForces, SmoothedPass, findForces)
BULLETFEM_EXPORT_KERNEL(productStrains, SmoothedProduct, findStrains)
BULLETFEM_EXPORT_KERNEL(productForces, SmoothedProduct, findForces)
BULLETFEM_EXPORT(averageFloat,
                 template <> void averageStrains(const EdgeSmoothing<float>& smoothing,
                                                 const SmoothedStrain<float>& strain, Range domains),
                 smoothing, strain, domains)
BULLETFEM_EXPORT(averageDouble,
                 template <> void averageStrains(const EdgeSmoothing<double>& smoothing,
                                                 const SmoothedStrain<double>& strain, Range domains),
                 smoothing, strain, domains)

template <class Real>
EdgeSmoothing<Real>::EdgeSmoothing(const RestShape& shape, const ElementLanes& lanes)
{
    const EdgeDomains& domains = shape.m_edgeDomains;
    if (domains.empty()) return;
    m_lanes.resize(lanes.blockCount());
    for (int lane = 0; lane < lanes.blockCount() * kLanes; ++lane)
    {
        const int e = lanes.m_element[lane];
        BlockShares& to = m_lanes[lane / kLanes];
        to.m_own[lane % kLanes] = static_cast<Real>(1 - domains.m_share[e]);
        to.m_ofDomain[lane % kLanes] = static_cast<Real>(domains.m_share[e] / 6);
        for (int k = 0; k < 6; ++k) to.m_domain[lane % kLanes][k] = domains.m_domain[e][k];
    }
    m_start = domains.m_start;
    for (const int e : domains.m_element)
    {
        const int lane = lanes.m_lane[e];
        m_place.push_back(lane / kLanes * 2 * kLanes + lane % kLanes);
    }
    m_weight.assign(domains.m_weight.begin(), domains.m_weight.end());
}

template struct EdgeSmoothing<float>;
template struct EdgeSmoothing<double>;

}  // namespace bullet_fem
#endif
