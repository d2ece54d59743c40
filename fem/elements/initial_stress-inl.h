// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Contribution of initial stress to an ElementPass. Included once for every instruction set.
#if defined(BULLETFEM_INITIAL_STRESS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_INITIAL_STRESS_INL_H
#undef BULLETFEM_INITIAL_STRESS_INL_H
#else
#define BULLETFEM_INITIAL_STRESS_INL_H
#endif

#include "fem/elements/element_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// f_1, f_2, f_3 in the columns, as stored by storeCorners().
template <class Real>
HWY_INLINE Matrix<Real> loadCorners(const CornerBlock<Real>& from, int lane)
{
    const Lanes<Real> d;
    Matrix<Real> f;
    Vector<Real> zero;
    HWY_UNROLL(3)
    for (int a = 0; a < 3; ++a)
        hn::LoadInterleaved4(d, from.m_vector[a + 1][lane], f.m[0][a], f.m[1][a], f.m[2][a], zero);
    return f;
}

/// The strain in the world frame that passElements() computes, with doubled shears.
template <class Real, class Elements>
HWY_INLINE Symmetric<Real> strainAgain(const Elements& elements, const Quaternions<Real>& q)
{
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    return strainOf(edgesMinusRotated(elements, q), timesTranspose(R, elements.DmInverse()));
}

/// R S R^T.
template <class Real>
HWY_INLINE Symmetric<Real> turnedBy(const Matrix<Real>& R, const Symmetric<Real>& S)
{
    const Matrix<Real> RS = times(R, full(S));
    const auto entry = [&](int i, int j)
    { return dot3(RS.m[i][0], R.m[j][0], RS.m[i][1], R.m[j][1], RS.m[i][2], R.m[j][2]); };
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(1, 2), entry(0, 2), entry(0, 1)};
}

/// The axial vector w of W in withInitialStress(), with doubled shears of the strain.
template <class Real>
HWY_INLINE void balanceTorque(const Symmetric<Real>& strain, const Symmetric<Real>& tau, Vector<Real> (&w)[3])
{
    using V = Vector<Real>;
    const SpinMatrix<Real> spin(strain);
    // Y = B tau; B tau - tau B = Y - Y^T
    const Matrix<Real> Y = times(full(spin.m_stretch), full(tau));
    const V c0 = Y.m[2][1] - Y.m[1][2], c1 = Y.m[0][2] - Y.m[2][0], c2 = Y.m[1][0] - Y.m[0][1];
    const Symmetric<Real>& A = spin.m_adjugate;
    w[0] = spin.m_inverse * dot3(A.xx, c0, A.xy, c1, A.xz, c2);
    w[1] = spin.m_inverse * dot3(A.xy, c0, A.yy, c1, A.yz, c2);
    w[2] = spin.m_inverse * dot3(A.xz, c0, A.yz, c1, A.zz, c2);
}

/// Adds the forces of the initial stress sigma_0 = elements.initialStress(), which includes V, and returns `elastic` +
/// R sigma_0 R^T. The energy is sigma_0 : (S - I), F = R S. Its derivative by F is R (sigma_0 + W), because R rotates
/// as F changes: W is the skew matrix that makes the element's torque zero, (sigma_0 + W) S = S (sigma_0 + W)^T. In the
/// world frame, with tau = R sigma_0 R^T, B = R S R^T and W = [w]x:
///     W B + B W = B tau - tau B   <=>   (tr(B) I - B) w = axl(B tau - tau B)
/// If S and sigma_0 share their axes W is zero; else it is of the order of the strain times sigma_0.
template <class Real, class Elements>
HWY_INLINE Symmetric<Real> withInitialStress(const Elements& elements, const Quaternions<Real>& q,
                                             const Symmetric<Real>& strain, const Symmetric<Real>& elastic)
{
    const Symmetric<Real> tau = turnedBy(toMatrix(q, number<Real>(2)), elements.initialStress());
    Vector<Real> w[3];
    balanceTorque(strain, tau, w);
    // minus (tau + [w]x)
    const Matrix<Real> P = {{{hn::Neg(tau.xx), w[2] - tau.xy, hn::Neg(w[1] + tau.xz)},
                             {hn::Neg(w[2] + tau.xy), hn::Neg(tau.yy), w[0] - tau.yz},
                             {w[1] - tau.xz, hn::Neg(w[0] + tau.yz), hn::Neg(tau.zz)}}};
    elements.addForces(timesTranspose(P, elements.loadGradients()));
    return plus(elastic, tau);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
