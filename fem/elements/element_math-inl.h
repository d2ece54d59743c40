// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Element forces and stresses from edges and rotations, several elements at a time: side by side in a body's blocks, or
// one element of several bodies. Included once for every instruction set.
#if defined(BULLETFEM_ELEMENT_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_ELEMENT_MATH_INL_H
#undef BULLETFEM_ELEMENT_MATH_INL_H
#else
#define BULLETFEM_ELEMENT_MATH_INL_H
#endif

#include "fem/elements/deformed_edges-inl.h"
#include "fem/elements/positive_part-inl.h"

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// The strain sym(A B^T) with doubled shears.
template <class Real>
HWY_INLINE Symmetric<Real> strainOf(const Matrix<Real>& A, const Matrix<Real>& B)
{
    const auto entry = [&](int i, int j)
    { return dot3(A.m[i][0], B.m[j][0], A.m[i][1], B.m[j][1], A.m[i][2], B.m[j][2]); };
    return {entry(0, 0),
            entry(1, 1),
            entry(2, 2),
            entry(1, 2) + entry(2, 1),
            entry(0, 2) + entry(2, 0),
            entry(0, 1) + entry(1, 0)};
}

/// sym(R^T A) with doubled shears.
template <class Real>
HWY_INLINE Symmetric<Real> strainInFrameOf(const Matrix<Real>& R, const Matrix<Real>& A)
{
    const auto entry = [&](int i, int j)
    { return dot3(R.m[0][i], A.m[0][j], R.m[1][i], A.m[1][j], R.m[2][i], A.m[2][j]); };
    return {entry(0, 0),
            entry(1, 1),
            entry(2, 2),
            entry(1, 2) + entry(2, 1),
            entry(0, 2) + entry(2, 0),
            entry(0, 1) + entry(1, 0)};
}

/// Stress 2 mu E + pressure I of a strain with doubled shears; mu includes the volume.
template <class Real>
HWY_INLINE Symmetric<Real> hookeUnder(Vector<Real> pressure, Vector<Real> mu, const Symmetric<Real>& E)
{
    const Vector<Real> twoMu = mu + mu;
    return {hn::MulAdd(twoMu, E.xx, pressure),
            hn::MulAdd(twoMu, E.yy, pressure),
            hn::MulAdd(twoMu, E.zz, pressure),
            mu * E.yz,
            mu * E.xz,
            mu * E.xy};
}

/// Stress 2 mu E + lambda tr(E) I of a strain with doubled shears; the Lame constants include the volume.
template <class Real>
HWY_INLINE Symmetric<Real> hooke(Vector<Real> lambda, Vector<Real> mu, const Symmetric<Real>& E)
{
    return hookeUnder<Real>(lambda * trace(E), mu, E);
}

/// ElementPass for rotated elements, without the tension, which is the positive part of the returned stress. Strains
/// and stresses are in the world frame, R E R^T = sym(F R^T) - I: with F R^T = D_s g'^T, g' = R D_m^-T, forces and
/// tension need R through g' only. Elements provides edges(part), restEdges(part), velocityEdges(), DmInverse(),
/// lambda(), mu() and damping(), and receives forces (columns f_1, f_2, f_3) and gradients (columns g'_1, g'_2, g'_3).
/// Calls other(part), part in [0, 3], between the stages of the work.
template <class Real, class Elements, class Other>
HWY_INLINE Symmetric<Real> passElements(const Elements& elements, const Quaternions<Real>& q, const Other& other)
{
    const Vector<Real> lambda = elements.lambda(), mu = elements.mu();
    other(0);
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    const Matrix<Real> g = timesTranspose(R, elements.DmInverse());  // R D_m^-T
    // D_s - R D_m instead of D_s, because sym(F R^T) - I would lose small strains to rounding.
    const Matrix<Real> stretch = edgesMinusRotated(elements, q);
    const Symmetric<Real> strain = strainOf(stretch, g);
    other(1);
    const Symmetric<Real> rate = strainOf(elements.velocityEdges(), g);
    const Symmetric<Real> damped = combined<Real>(elements.damping(), rate, number<Real>(1), strain);
    const Symmetric<Real> minusStress = hooke<Real>(hn::Neg(lambda), hn::Neg(mu), damped);
    other(2);
    elements.storeForces(times(full(minusStress), g));
    elements.storeGradients(g);
    other(3);
    return hooke<Real>(lambda, mu, strain);
}

/// Pressure lambda D + 2/3 mu (D - own) of an element of volume change `own` in a patch of volume change D. With it, 2
/// mu E + pressure I is 2 mu dev(E) plus the bulk modulus times D.
template <class Real>
HWY_INLINE Vector<Real> pressureInPatch(Vector<Real> lambda, Vector<Real> mu, Vector<Real> own, Vector<Real> D)
{
    return hn::MulAdd(lambda, D, number<Real>(2.0 / 3) * mu * (D - own));
}

/// The elements of a patch, or of as many patches as a vector has lanes, in two passes: first each element's strains,
/// then, with the mean volume change, forces and stress. Elements are those of passElements(), with share(), of their
/// patch's volume, and loadGradients(), with rows g'_1, g'_2, g'_3.
template <class Real>
struct PatchStrains
{
    HWY_INLINE PatchStrains() = default;  // an implicit one would not be compiled for the instruction set

    /// Adds element k of the patch. Stores its gradients.
    template <class Elements>
    HWY_INLINE void add(int k, const Elements& elements, const Quaternions<Real>& q)
    {
        const Matrix<Real> R = toMatrix(q, number<Real>(2));
        const Matrix<Real> g = timesTranspose(R, elements.DmInverse());
        const Matrix<Real> stretch = edgesMinusRotated(elements, q);
        m_strain[k] = strainOf(stretch, g);
        const Symmetric<Real> rate = strainOf(elements.velocityEdges(), g);
        elements.storeGradients(g);
        m_damped[k] = combined<Real>(elements.damping(), rate, number<Real>(1), m_strain[k]);
        const Vector<Real> share = elements.share();
        m_dilatation = k == 0 ? share * trace(m_strain[k]) : hn::MulAdd(share, trace(m_strain[k]), m_dilatation);
        m_dampedDilatation =
            k == 0 ? share * trace(m_damped[k]) : hn::MulAdd(share, trace(m_damped[k]), m_dampedDilatation);
    }

    /// Stores the forces of element k and returns its stress.
    template <class Elements>
    HWY_INLINE Symmetric<Real> finish(int k, const Elements& elements) const
    {
        const Vector<Real> lambda = elements.lambda(), mu = elements.mu();
        const Vector<Real> damped = pressureInPatch<Real>(lambda, mu, trace(m_damped[k]), m_dampedDilatation);
        const Symmetric<Real> minusStress = hookeUnder<Real>(hn::Neg(damped), hn::Neg(mu), m_damped[k]);
        elements.storeForces(timesTranspose(full(minusStress), elements.loadGradients()));
        return hookeUnder<Real>(pressureInPatch<Real>(lambda, mu, trace(m_strain[k]), m_dilatation), mu, m_strain[k]);
    }

    Symmetric<Real> m_strain[ElementPatches::kMax], m_damped[ElementPatches::kMax];
    Vector<Real> m_dilatation, m_dampedDilatation;
};

/// The tension of an ElementPass from a stress.
template <class Real>
HWY_INLINE Symmetric<Real> tensionOf(double factor, const Symmetric<Real>& elastic)
{
    const Vector<Real> zero = number<Real>(0);
    if (factor == 0) return {zero, zero, zero, zero, zero, zero};
    return positivePart(number<Real>(factor), elastic, farEigenvalue(elastic));
}

template <class Real>
HWY_INLINE Vector<Real> trace(const Matrix<Real>& H)
{
    return H.m[0][0] + H.m[1][1] + H.m[2][2];
}

/// pressure I + mu (H + H^T) + H T; the pressure is lambda tr(H) without patches.
template <class Real>
HWY_INLINE Matrix<Real> warpedStress(Vector<Real> pressure, Vector<Real> mu, const Symmetric<Real>& T,
                                     const Matrix<Real>& H)
{
    using V = Vector<Real>;
    Matrix<Real> P;
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i)
    {
        const V a = H.m[i][0], b = H.m[i][1], c = H.m[i][2];
        P.m[i][0] = hn::MulAdd(mu, a + H.m[0][i], dot3(a, T.xx, b, T.xy, c, T.xz));
        P.m[i][1] = hn::MulAdd(mu, b + H.m[1][i], dot3(a, T.xy, b, T.yy, c, T.yz));
        P.m[i][2] = hn::MulAdd(mu, c + H.m[2][i], dot3(a, T.xz, b, T.yz, c, T.zz));
        P.m[i][i] = P.m[i][i] + pressure;
    }
    return P;
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#endif
