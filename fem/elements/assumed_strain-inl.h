// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Elements of assumed strain (AssumedStrain), in patches. Included once for every instruction set.
#if defined(BULLETFEM_ASSUMED_STRAIN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_ASSUMED_STRAIN_INL_H
#undef BULLETFEM_ASSUMED_STRAIN_INL_H
#else
#define BULLETFEM_ASSUMED_STRAIN_INL_H
#endif

#include "fem/elements/initial_stress-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// A symmetric 6x6 matrix times a strain with doubled shears; entry(k) are those of the upper triangle, row by row.
template <class Real, class Entry>
HWY_INLINE Symmetric<Real> symmetricTimes(const Entry& entry, const Symmetric<Real>& E)
{
    using V = Vector<Real>;
    const V in[6] = {E.xx, E.yy, E.zz, E.yz, E.xz, E.xy};
    V out[6];
    HWY_UNROLL(6)
    for (int column = 0; column < 6; ++column) out[column] = entry(column) * in[0];
    HWY_UNROLL(5)
    for (int column = 1; column < 6; ++column) out[0] = hn::MulAdd(entry(column), in[column], out[0]);
    int next = 6;
    HWY_UNROLL(5)
    for (int row = 1; row < 6; ++row)
    {
        HWY_UNROLL(5)
        for (int column = row; column < 6; ++column, ++next)
        {
            const V m = entry(next);
            out[row] = hn::MulAdd(m, in[column], out[row]);
            if (column > row) out[column] = hn::MulAdd(m, in[row], out[column]);
        }
    }
    return {out[0], out[1], out[2], out[3], out[4], out[5]};
}

template <class Real>
HWY_INLINE Symmetric<Real> noStrain()
{
    const Vector<Real> zero = number<Real>(0);
    return {zero, zero, zero, zero, zero, zero};
}

/// V times the stress of Hooke's law that does the work of the assumed strain, in the element's frame, for the
/// element's strain E and the patch's mean strain, with doubled shears: V C mean + 2 mu V H^2 (E - mean). The moduli
/// include V; entry(k) are those of ElementBlocks::m_filter.
template <class Real, class Entry>
HWY_INLINE Symmetric<Real> assumedStress(Vector<Real> lambda, Vector<Real> mu, const Entry& entry,
                                         const Symmetric<Real>& E, const Symmetric<Real>& mean)
{
    const Symmetric<Real> deviation = combined<Real>(number<Real>(1), E, number<Real>(-1), mean);
    return combined<Real>(mu + mu, symmetricTimes<Real>(entry, deviation), number<Real>(1),
                          hooke<Real>(lambda, mu, mean));
}

/// The elements of a patch, as PatchStrains, in the elements' frames. Stores rotations R in place of gradients, and
/// tensions in the element's frame. Elements also have hasInitialStress(), initialStress(), storeRotation(),
/// loadRotation() and filter(k), entry k of ElementBlocks::m_filter.
template <class Real>
struct PatchAssumed
{
    HWY_INLINE PatchAssumed() : m_mean(noStrain<Real>()), m_dampedMean(m_mean) {}

    template <class Elements>
    HWY_INLINE void add(int k, const Elements& elements, const Quaternions<Real>& q)
    {
        const Matrix<Real> R = toMatrix(q, number<Real>(2)), DmInverse = elements.DmInverse();
        m_strain[k] = strainInFrameOf(R, times(edgesMinusRotated(elements, q), DmInverse));
        const Symmetric<Real> rate = strainInFrameOf(R, times(elements.velocityEdges(), DmInverse));
        elements.storeRotation(R);
        m_damped[k] = combined<Real>(elements.damping(), rate, number<Real>(1), m_strain[k]);
        const Vector<Real> share = elements.share();
        m_mean = k == 0 ? times<Real>(m_strain[k], share) : combined<Real>(share, m_strain[k], number<Real>(1), m_mean);
        m_dampedMean = k == 0 ? times<Real>(m_damped[k], share)
                              : combined<Real>(share, m_damped[k], number<Real>(1), m_dampedMean);
    }

    /// Stores the forces of element k, f_a = -R (stress + W) g_a with the skew W that makes the element's torque zero
    /// (withInitialStress()), and returns its stress.
    template <class Elements>
    HWY_INLINE Symmetric<Real> finish(int k, const Elements& elements) const
    {
        const auto filter = [&elements](int entry) { return elements.filter(entry); };
        const Vector<Real> lambda = elements.lambda(), mu = elements.mu();
        Symmetric<Real> stress = assumedStress<Real>(lambda, mu, filter, m_strain[k], m_mean);
        Symmetric<Real> damped = assumedStress<Real>(lambda, mu, filter, m_damped[k], m_dampedMean);
        if (elements.hasInitialStress())
        {
            const Symmetric<Real> initial = elements.initialStress();
            stress = plus(stress, initial);
            damped = plus(damped, initial);
        }
        Vector<Real> w[3];
        balanceTorque(m_strain[k], stress, w);
        const Matrix<Real> minusP = {{{hn::Neg(damped.xx), w[2] - damped.xy, hn::Neg(w[1] + damped.xz)},
                                      {hn::Neg(w[2] + damped.xy), hn::Neg(damped.yy), w[0] - damped.yz},
                                      {w[1] - damped.xz, hn::Neg(w[0] + damped.yz), hn::Neg(damped.zz)}}};
        elements.storeForces(times(elements.loadRotation(), timesTranspose(minusP, elements.DmInverse())));
        return stress;
    }

    template <class Elements>
    HWY_INLINE void storeTension(const Elements& elements, const Symmetric<Real>& tension) const
    {
        elements.storeTension(tension);
    }

    Symmetric<Real> m_strain[ElementPatches::kMax], m_damped[ElementPatches::kMax];
    Symmetric<Real> m_mean, m_dampedMean;
};

/// The elements of a patch in a product with K'.
template <class Real>
struct PatchAssumedProduct
{
    HWY_INLINE PatchAssumedProduct() : m_mean(noStrain<Real>()) {}

    /// Adds element k with the edges of the argument.
    template <class Elements>
    HWY_INLINE void add(int k, const Elements& elements, const Matrix<Real>& edges)
    {
        m_gradient[k] = times(edges, elements.DmInverse());
        m_strain[k] = strainInFrameOf(elements.loadRotation(), m_gradient[k]);
        const Vector<Real> share = elements.share();
        m_mean = k == 0 ? times<Real>(m_strain[k], share) : combined<Real>(share, m_strain[k], number<Real>(1), m_mean);
    }

    /// f_1, f_2, f_3 of element k in the columns.
    template <class Elements>
    HWY_INLINE Matrix<Real> forces(int k, const Elements& elements, Vector<Real> stiffnessFactor) const
    {
        const auto filter = [&elements](int entry) { return elements.filter(entry); };
        const Symmetric<Real> stress = assumedStress<Real>(
            stiffnessFactor * elements.lambda(), stiffnessFactor * elements.mu(), filter, m_strain[k], m_mean);
        const Matrix<Real> P =
            plus(times(elements.loadRotation(), full(stress)), times(m_gradient[k], full(elements.loadTension())));
        return timesTranspose(P, elements.DmInverse());
    }

private:
    Matrix<Real> m_gradient[ElementPatches::kMax];
    Symmetric<Real> m_strain[ElementPatches::kMax], m_mean;
};

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
