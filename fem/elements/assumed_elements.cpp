// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/assumed_elements.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/assumed_elements.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/assumed_strain-inl.h"
#include "fem/elements/response_elements-inl.h"
#include "fem/elements/stretch_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// The rest data of one element of every patch of a column.
template <class Real>
struct AssumedLanes
{
    const ElementBlocks<Real>& m_all;
    int m_block, m_lane, m_group;

    HWY_INLINE const ElementBlock<Real>& block() const { return m_all.m_blocks[m_block]; }
    HWY_INLINE Vector<Real> share() const { return hn::Load(Lanes<Real>(), m_all.m_share[m_block].m_lane + m_lane); }
    HWY_INLINE Vector<Real> lambda() const { return hn::Load(Lanes<Real>(), block().m_lambdaVolume + m_lane); }
    HWY_INLINE Vector<Real> mu() const { return hn::Load(Lanes<Real>(), block().m_muVolume + m_lane); }
    HWY_INLINE Matrix<Real> DmInverse() const { return loadMatrix(block().m_DmInverse, m_lane); }
    /// H a, for a with doubled shears.
    HWY_INLINE Symmetric<Real> filtered(const Symmetric<Real>& a) const
    {
        const auto entry = [this](int k)
        { return hn::Load(Lanes<Real>(), m_all.m_filter[m_group].m_entry[k] + m_lane); };
        return symmetricTimes<Real>(entry, a);
    }
};

/// The laws of these elements in a pass. Elements of respond().
template <class Real>
struct LawLanesOfPass
{
    const ElementPass<Real>& m_pass;
    const AssumedLanes<Real>& m_elements;

    HWY_INLINE Vector<Real> mu() const { return m_elements.mu(); }
    HWY_INLINE Vector<Real> law() const
    {
        return hn::Load(Lanes<Real>(), m_elements.m_all.m_law[m_elements.m_block].m_lane + m_elements.m_lane);
    }
    HWY_INLINE void respondOneByOne(Vector<Real> lambda, Vector<Real> pressure, const Symmetric<Real>& e,
                                    ResponseLanes<Real>& law) const
    {
        respondSingly(m_elements.m_all, m_pass.m_history, m_elements.m_block * kLanes + m_elements.m_lane, lambda,
                      pressure, e, law);
    }
};

/// Tensors of the elements of a column, without doubled shears, and their weighted sum over the patches.
template <class Real>
struct PatchMean
{
    HWY_INLINE PatchMean() : m_mean(noStrain<Real>()) {}

    HWY_INLINE void add(int k, Vector<Real> weight, const Symmetric<Real>& a)
    {
        m_of[k] = a;
        m_mean = k == 0 ? times<Real>(a, weight) : combined<Real>(weight, a, number<Real>(1), m_mean);
    }
    /// share times the mean, plus H of the rest of element k.
    HWY_INLINE Symmetric<Real> assumed(int k, const AssumedLanes<Real>& elements, Vector<Real> share) const
    {
        const Symmetric<Real> rest = combined<Real>(number<Real>(1), m_of[k], hn::Neg(share), m_mean);
        return combined<Real>(share, m_mean, number<Real>(1), elements.filtered(withDoubling(rest)));
    }

    Symmetric<Real> m_of[ElementPatches::kMax], m_mean;
};

template <class Real>
HWY_INLINE Symmetric<Real> matrixStress(const AssumedLanes<Real>& elements, const Symmetric<Real>& strain)
{
    const Symmetric<Real> doubled = withDoubling(strain);
    return plus(hooke<Real>(elements.lambda(), elements.mu(), doubled),
                stiffnessTimes(elements.m_all.m_stiffness[elements.m_block], elements.m_lane, doubled));
}

/// l C (C : e) + 2 k mu e of a strain without doubled shears, or C e of an anisotropic law.
template <class Real>
HWY_INLINE Symmetric<Real> tangentStress(const AssumedLanes<Real>& elements, const TangentBlock<Real>* tangent,
                                         const Symmetric<Real>& strain)
{
    if (!tangent) return matrixStress(elements, strain);
    const Lanes<Real> d;
    const TangentBlock<Real>& block = tangent[elements.m_block];
    const Symmetric<Real> C = loadSymmetric(block.m_cofactor, elements.m_lane);
    const Vector<Real> bulk = hn::Load(d, block.m_bulk + elements.m_lane),
                       shear = hn::Load(d, block.m_patchBulk + elements.m_lane), mu = elements.mu();
    return combined<Real>(bulk * contraction(C, strain), C, (mu + mu) * shear, strain);
}

/// V sigma~, the stress of the law at an assumed strain; stores the tangent of a law that varies.
template <class Real>
HWY_INLINE Symmetric<Real> lawStress(const ElementPass<Real>& pass, const AssumedLanes<Real>& elements,
                                     const Symmetric<Real>& strain)
{
    if (!pass.m_tangent) return matrixStress(elements, strain);
    const LawLanesOfPass<Real> laws = {pass, elements};
    const ResponseLanes<Real> law = respond<Real>(laws, elements.lambda(), number<Real>(0), withDoubling(strain));
    const Lanes<Real> d;
    TangentBlock<Real>& out = pass.m_tangent[elements.m_block];
    storeSymmetric(law.m_cofactor, out.m_cofactor, elements.m_lane);
    hn::Store(law.m_bulk, d, out.m_bulk + elements.m_lane);
    hn::Store(law.m_shear, d, out.m_patchBulk + elements.m_lane);
    return law.m_stress;
}

template <class Real>
HWY_INLINE void storeFrame(const Matrix<Real>& R, const StretchLanes<Real>& stretch, StretchBlock<Real>& out, int lane)
{
    storeMatrix(R, out.m_rotation, lane);
    storeSymmetric(stretch.m_stretch, out.m_stretch, lane);
    storeSymmetric(stretch.m_spin, out.m_spin, lane);
}

/// Changes of the strains of a column's elements in the frame of their patch: with the mean Hm of their H, sym(H - Hm)
/// + dS(Hm). Without doubled shears.
template <class Real>
HWY_INLINE void strainChanges(const PatchColumn& column, const AssumedLanes<Real>& first,
                              const StretchLanes<Real>& stretch, const Matrix<Real>* H, PatchMean<Real>& changes)
{
    const auto share = [&](int k) {
        return AssumedLanes<Real>{first.m_all, first.m_block + k, first.m_lane, first.m_group}.share();
    };
    MeanGradient<Real> mean;
    for (int k = 0; k < column.m_size; ++k) mean.add(k, share(k), H[k]);
    const Symmetric<Real> turn =
        combined<Real>(number<Real>(1), stretch.change(mean.m_mean), number<Real>(-1), doubledPart(mean.m_mean));
    for (int k = 0; k < column.m_size; ++k) changes.add(k, share(k), withoutDoubling(plus(doubledPart(H[k]), turn)));
}

/// Stores the forces sign R (stress + share W) g_a of an element, with the axial vector w of W.
template <class Real>
HWY_INLINE void storeBalanced(double sign, const Matrix<Real>& R, const Matrix<Real>& P, const Vector<Real> (&w)[3],
                              const AssumedLanes<Real>& elements, CornerBlock<Real>& out)
{
    const Vector<Real> share = elements.share(), factor = number<Real>(sign);
    const Vector<Real> own[3] = {share * w[0], share * w[1], share * w[2]};
    const Matrix<Real> f = times(R, timesTranspose(plusSpin<Real>(P, own), elements.DmInverse()));
    Matrix<Real> signedForces;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) signedForces.m[k / 3][k % 3] = factor * f.m[k / 3][k % 3];
    storeCorners(signedForces, out, elements.m_lane);
}

/// The nodal data of the elements of a column.
template <class Real>
struct StagedColumn
{
    StagedEdges<double, width<Real>()> m_x[ElementPatches::kMax];
    StagedEdges<Real> m_v[ElementPatches::kMax];
};

template <class Real>
HWY_INLINE Quaternions<Real> turnFrame(const ElementPass<Real>& pass, const PatchColumn& column,
                                       const StagedColumn<Real>& staged)
{
    const auto lanes = [&](int k) {
        return AssumedLanes<Real>{*pass.m_elements, column.m_block + k, column.m_lane, column.m_group};
    };
    const auto rotation = [&](int k) { return pass.m_rotation + (column.m_block + k) * kLanes + column.m_lane; };
    Quaternions<Real> q = loadQuaternions(rotation(0), Real());
    if (pass.m_isRotated) return q;
    MeanGradient<Real> gradient;
    for (int k = 0; k < column.m_size; ++k)
    {
        const DeformedLanes<Real> deformed = {lanes(k).block(), staged.m_x[k], column.m_lane};
        gradient.add(k, lanes(k).share(), times(roundedEdges<Real>(deformed), deformed.DmInverse()));
    }
    polarRotations(&gradient.m_mean, 1, &q);
    for (int k = 0; k < column.m_size; ++k) storeQuaternions(q, rotation(k));
    return q;
}

template <class Real>
HWY_INLINE void passColumn(const StretchPass<Real>& pass, const PatchColumn& column, const StagedColumn<Real>& staged)
{
    const ElementPass<Real>& plain = pass.m_elements;
    const Vector<Real> one = number<Real>(1), damping = number<Real>(plain.m_damping);
    const int lane = column.m_lane;
    const auto lanes = [&](int k) {
        return AssumedLanes<Real>{*plain.m_elements, column.m_block + k, lane, column.m_group};
    };
    const Quaternions<Real> q = turnFrame(plain, column, staged);
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    Matrix<Real> displacement[ElementPatches::kMax], rate[ElementPatches::kMax];  // R^T F - I, R^T Fdot
    PatchMean<Real> strains, rates, stresses, viscous;
    for (int k = 0; k < column.m_size; ++k)
    {
        const DeformedLanes<Real> deformed = {lanes(k).block(), staged.m_x[k], lane};
        displacement[k] = inFrameOf(R, times(edgesMinusRotated(deformed, q), deformed.DmInverse()));
        rate[k] = inFrameOf(R, times(staged.m_v[k].load(), deformed.DmInverse()));
        strains.add(k, lanes(k).share(), withoutDoubling(doubledPart(displacement[k])));
    }
    StretchLanes<Real> stretch;
    stretch.find(withDoubling(strains.m_mean));
    strainChanges(column, lanes(0), stretch, rate, rates);
    for (int k = 0; k < column.m_size; ++k)
    {
        stresses.add(k, one, lawStress(plain, lanes(k), strains.assumed(k, lanes(k), one)));
        viscous.add(k, one, tangentStress(lanes(k), plain.m_tangent, rates.assumed(k, lanes(k), one)));
    }
    Matrix<Real> torque = times(full(stretch.m_stretch), full(times<Real>(viscous.m_mean, damping)));
    Symmetric<Real> stress[ElementPatches::kMax];
    for (int k = 0; k < column.m_size; ++k)
    {
        stress[k] = stresses.assumed(k, lanes(k), lanes(k).share());
        if (plain.m_initialStress)
            stress[k] = plus(stress[k], loadSymmetric(plain.m_initialStress[column.m_block + k].m_entry, lane));
        torque = plus(torque, times(displacement[k], full(stress[k])));
    }
    Vector<Real> w[3];
    stretch.turnOf(torque, w);
    storeFrame(R, stretch, pass.m_warped[column.m_block], lane);
    for (int k = 0; k < column.m_size; ++k)
    {
        const int b = column.m_block + k;
        const Symmetric<Real> damped =
            combined<Real>(damping, viscous.assumed(k, lanes(k), lanes(k).share()), one, stress[k]);
        storeBalanced(-1, R, full(damped), w, lanes(k), plain.m_force[b]);
        storeSymmetric(tensionOf(plain.m_tensionFactor, stress[k]), pass.m_warped[b].m_tension, lane);
    }
}

template <class Real>
void passAssumed(const StretchPass<Real>& pass, Range units)
{
    const ElementBlocks<Real>& all = *pass.m_elements.m_elements;
    StagedColumn<Real> staged[2];
    const auto stage = [&](const PatchColumn& column, int k, int slot)
    {
        const std::int32_t(*node)[4] = all.m_blocks[column.m_block + k].m_node + column.m_lane;
        staged[slot].m_x[k].stage(node, pass.m_elements.m_x);
        staged[slot].m_v[k].stage(node, pass.m_elements.m_v);
    };
    const auto compute = [&](const PatchColumn& column, int slot, const auto& other)
    {
        passColumn(pass, column, staged[slot]);
        for (int k = 0; k < column.m_size; ++k) other(k);
    };
    forEachColumn<Real>(all.m_groups, units, stage, compute);
}

template <class Real>
HWY_INLINE void multiplyColumn(const StretchProduct<Real>& product, const PatchColumn& column,
                               const StagedEdges<Real>* edges)
{
    const ElementProduct<Real>& plain = product.m_elements;
    const Vector<Real> one = number<Real>(1), factor = number<Real>(plain.m_stiffnessFactor);
    const int lane = column.m_lane;
    const auto lanes = [&](int k) {
        return AssumedLanes<Real>{*plain.m_elements, column.m_block + k, lane, column.m_group};
    };
    const StretchBlock<Real>& frame = product.m_warped[column.m_block];
    const Matrix<Real> R = loadMatrix(frame.m_rotation, lane);
    StretchLanes<Real> stretch;
    stretch.m_stretch = loadSymmetric(frame.m_stretch, lane);
    stretch.m_spin = loadSymmetric(frame.m_spin, lane);
    Matrix<Real> H[ElementPatches::kMax];
    PatchMean<Real> strains, stresses;
    for (int k = 0; k < column.m_size; ++k) H[k] = inFrameOf(R, times(edges[k].load(), lanes(k).DmInverse()));
    strainChanges(column, lanes(0), stretch, H, strains);
    for (int k = 0; k < column.m_size; ++k)
        stresses.add(k, one,
                     times<Real>(tangentStress(lanes(k), plain.m_tangent, strains.assumed(k, lanes(k), one)), factor));
    Vector<Real> w[3];
    stretch.turnOf(times(full(stretch.m_stretch), full(stresses.m_mean)), w);
    for (int k = 0; k < column.m_size; ++k)
    {
        const Symmetric<Real> T = loadSymmetric(product.m_warped[column.m_block + k].m_tension, lane);
        const Matrix<Real> P = plus(full(stresses.assumed(k, lanes(k), lanes(k).share())), times(H[k], full(T)));
        storeBalanced(1, R, P, w, lanes(k), plain.m_out[column.m_block + k]);
    }
}

template <class Real>
void multiplyAnyAssumed(const StretchProduct<Real>& product, Range units)
{
    const ElementProduct<Real>& plain = product.m_elements;
    const ElementBlocks<Real>& all = *plain.m_elements;
    StagedEdges<Real> edges[2][ElementPatches::kMax];
    const auto stage = [&](const PatchColumn& column, int k, int slot)
    { edges[slot][k].stage(all.m_blocks[column.m_block + k].m_node + column.m_lane, plain.m_p); };
    const auto compute = [&](const PatchColumn& column, int slot, const auto& other)
    {
        multiplyColumn(product, column, edges[slot]);
        for (int k = 0; k < column.m_size; ++k) other(k);
    };
    forEachColumn<Real>(all.m_groups, units, stage, compute);
}

BULLETFEM_KERNEL(passAssumed, StretchPass)
BULLETFEM_KERNEL(multiplyAnyAssumed, StretchProduct)

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT_KERNEL(passAssumed, StretchPass, runAssumedPass)
BULLETFEM_EXPORT_KERNEL(multiplyAnyAssumed, StretchProduct, runAssumedProduct)

}  // namespace bullet_fem
#endif
