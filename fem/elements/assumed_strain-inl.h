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

/// V times the stress of Hooke's law that does the work of the assumed strain, in the patch's frame, for the
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

/// P + [w]x.
template <class Real>
HWY_INLINE Matrix<Real> plusSpin(Matrix<Real> P, const Vector<Real> (&w)[3])
{
    P.m[0][1] = P.m[0][1] - w[2], P.m[1][0] = P.m[1][0] + w[2];
    P.m[0][2] = P.m[0][2] + w[1], P.m[2][0] = P.m[2][0] - w[1];
    P.m[1][2] = P.m[1][2] - w[0], P.m[2][1] = P.m[2][1] + w[0];
    return P;
}

/// Mean deformation gradient of a patch; for columns of copies, whose shares are 0, that of the first.
template <class Real>
struct MeanGradient
{
    HWY_INLINE MeanGradient()  // an implicit one would not be compiled for the instruction set
    {
        HWY_UNROLL(9)
        for (int i = 0; i < 9; ++i) m_first.m[i / 3][i % 3] = m_mean.m[i / 3][i % 3] = number<Real>(0);
    }

    HWY_INLINE void add(int k, Vector<Real> share, const Matrix<Real>& F)
    {
        if (k == 0) m_first = m_mean = F;
        HWY_UNROLL(9)
        for (int i = 0; i < 9 && k > 0; ++i)
            m_mean.m[i / 3][i % 3] =
                hn::MulAdd(share, F.m[i / 3][i % 3] - m_first.m[i / 3][i % 3], m_mean.m[i / 3][i % 3]);
    }

    Matrix<Real> m_first, m_mean;
};

/// The elements of a patch, as PatchStrains, in the frame of the patch (AssumedStrain). First addGradient() for all,
/// then setFrame() with the polar rotation of m_gradient.m_mean, add() for all, respond() for all, and finish(). Stores
/// rotations R in place of gradients, and tensions in the frame. Elements also have hasInitialStress(),
/// initialStress(), storeRotation(), loadRotation() and filter(k), entry k of ElementBlocks::m_filter.
template <class Real>
struct PatchAssumed
{
    HWY_INLINE PatchAssumed() : m_mean(noStrain<Real>()), m_dampedMean(m_mean) {}

    template <class Elements>
    HWY_INLINE void addGradient(int k, const Elements& elements)
    {
        m_gradient.add(k, elements.share(), times(roundedEdges<Real>(elements), elements.DmInverse()));
    }

    HWY_INLINE void setFrame(const Quaternions<Real>& q)
    {
        m_q = q;
        m_R = toMatrix(q, number<Real>(2));
    }

    template <class Elements>
    HWY_INLINE void add(int k, const Elements& elements)
    {
        const Matrix<Real> DmInverse = elements.DmInverse();
        m_displacement[k] = inFrameOf(m_R, times(edgesMinusRotated(elements, m_q), DmInverse));
        m_strain[k] = doubledPart(m_displacement[k]);
        const Symmetric<Real> rate = strainInFrameOf(m_R, times(elements.velocityEdges(), DmInverse));
        elements.storeRotation(m_R);
        m_damped[k] = combined<Real>(elements.damping(), rate, number<Real>(1), m_strain[k]);
        const Vector<Real> share = elements.share();
        m_mean = k == 0 ? times<Real>(m_strain[k], share) : combined<Real>(share, m_strain[k], number<Real>(1), m_mean);
        m_dampedMean = k == 0 ? times<Real>(m_damped[k], share)
                              : combined<Real>(share, m_damped[k], number<Real>(1), m_dampedMean);
    }

    /// Finds the elastic stress of element k.
    template <class Elements>
    HWY_INLINE void respond(int k, const Elements& elements)
    {
        const auto filter = [&elements](int entry) { return elements.filter(entry); };
        m_stress[k] = assumedStress<Real>(elements.lambda(), elements.mu(), filter, m_strain[k], m_mean);
        if (elements.hasInitialStress()) m_stress[k] = plus(m_stress[k], elements.initialStress());
        const Matrix<Real> torque = times(m_displacement[k], full(m_stress[k]));
        m_torque = k == 0 ? torque : plus(m_torque, torque);
    }

    /// Stores the forces of element k, f_a = -R (stress + share W) g_a with the skew W that makes the patch's torque
    /// zero: (tr(S) I - S) w = axl(M - M^T), M the sum of (R^T F) stress. Returns the elastic stress.
    template <class Elements>
    HWY_INLINE Symmetric<Real> finish(int k, const Elements& elements)
    {
        if (k == 0) balance();
        const auto filter = [&elements](int entry) { return elements.filter(entry); };
        Symmetric<Real> damped =
            assumedStress<Real>(elements.lambda(), elements.mu(), filter, m_damped[k], m_dampedMean);
        if (elements.hasInitialStress()) damped = plus(damped, elements.initialStress());
        const Vector<Real> minusShare = hn::Neg(elements.share());
        const Vector<Real> w[3] = {minusShare * m_w[0], minusShare * m_w[1], minusShare * m_w[2]};
        const Matrix<Real> minusP = plusSpin<Real>(full(times<Real>(damped, number<Real>(-1))), w);
        elements.storeForces(times(m_R, timesTranspose(minusP, elements.DmInverse())));
        return m_stress[k];
    }

    MeanGradient<Real> m_gradient;

private:
    HWY_INLINE void balance()
    {
        const SpinMatrix<Real> spin(m_mean);
        const Symmetric<Real>& A = spin.m_adjugate;
        const Matrix<Real>& M = m_torque;
        const Vector<Real> a = M.m[2][1] - M.m[1][2], b = M.m[0][2] - M.m[2][0], c = M.m[1][0] - M.m[0][1];
        m_w[0] = spin.m_inverse * dot3(A.xx, a, A.xy, b, A.xz, c);
        m_w[1] = spin.m_inverse * dot3(A.xy, a, A.yy, b, A.yz, c);
        m_w[2] = spin.m_inverse * dot3(A.xz, a, A.yz, b, A.zz, c);
    }

    Matrix<Real> m_displacement[ElementPatches::kMax];  // R^T F - I
    Symmetric<Real> m_strain[ElementPatches::kMax], m_damped[ElementPatches::kMax], m_stress[ElementPatches::kMax];
    Symmetric<Real> m_mean, m_dampedMean;
    Quaternions<Real> m_q;
    Matrix<Real> m_R, m_torque;
    Vector<Real> m_w[3];
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
