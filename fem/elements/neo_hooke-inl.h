// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The law of neo_hooke.h for several elements at a time. Included once for every instruction set.
#if defined(BULLETFEM_NEO_HOOKE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_NEO_HOOKE_INL_H
#undef BULLETFEM_NEO_HOOKE_INL_H
#else
#define BULLETFEM_NEO_HOOKE_INL_H
#endif

#include "fem/elements/element_math-inl.h"
#include "fem/elements/neo_hooke.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// NeoHookeResponse without the energy; Hooke's response in lanes with Hooke's law.
template <class Real>
struct NeoHookeLanes
{
    HWY_INLINE NeoHookeLanes() = default;  // an implicit one would not be compiled for the instruction set

    Symmetric<Real> m_stress, m_cofactor;
    Vector<Real> m_bulk, m_shear;
};

/// A : B of symmetric matrices.
template <class Real>
HWY_INLINE Vector<Real> contraction(const Symmetric<Real>& A, const Symmetric<Real>& B)
{
    return hn::MulAdd(number<Real>(2), dot3(A.yz, B.yz, A.xz, B.xz, A.xy, B.xy),
                      dot3(A.xx, B.xx, A.yy, B.yy, A.zz, B.zz));
}

/// The law's response to a strain e whose shears are not doubled.
template <class Real>
HWY_INLINE NeoHookeLanes<Real> neoHooke(Vector<Real> lambda, Vector<Real> mu, const Symmetric<Real>& e)
{
    using V = Vector<Real>;
    const V zero = number<Real>(0), half = number<Real>(0.5), one = number<Real>(1);
    const Symmetric<Real> adjugateOfE = adjugate(e);
    const V tr = trace(e);
    const V det = dot3(e.xx, adjugateOfE.xx, e.xy, adjugateOfE.xy, e.xz, adjugateOfE.xz);
    const V j = tr + trace(adjugateOfE) + det;
    const V above = hn::Max(j, number<Real>(kMinVolumeRatio - 1)), below = j - above;
    const V inverse = one / (one + above), squared = inverse * inverse;
    const V curvature = hn::MulAdd(half * lambda, one + squared, mu * squared);
    const V slope = above * hn::MulAdd(lambda, hn::MulAdd(half, above, one), mu) * inverse;
    const V q = hn::MulAdd(curvature, below, slope);

    NeoHookeLanes<Real> result;
    Symmetric<Real>& C = result.m_cofactor;
    const Symmetric<Real> deviating = combined<Real>(one, adjugateOfE, hn::Neg(one), e);
    C = shifted<Real>(deviating, one + tr);
    const Symmetric<Real> linear = combined<Real>(mu + mu, e, hn::Neg(mu), adjugateOfE);
    result.m_stress = combined<Real>(q, C, one, shifted<Real>(linear, hn::Neg(mu * tr)));
    const V least = number<Real>(1e-30), traceOfC = trace(C);
    const V perSquares = one / hn::Max(contraction(C, C), least);
    const V likeness = half * hn::MulSub(traceOfC * traceOfC, perSquares, one);
    result.m_bulk = hn::Max(zero, curvature - number<Real>(3) * mu * (likeness * likeness * perSquares));
    const V third = number<Real>(1.0 / 3);
    const Symmetric<Real> deviator = shifted<Real>(e, hn::Neg(third * tr));
    const V shear = number<Real>(2.0 / 3) * contraction(deviator, deviator);
    const V stretch = hn::Max(zero, hn::MulAdd(third, tr, one) + hn::Sqrt(shear));
    // Padding lanes have mu = 0.
    result.m_shear = hn::Max(one, half * hn::MulAdd(hn::Abs(q - mu), stretch / hn::Max(mu, least), one));
    return result;
}

template <class Real, class Mask>
HWY_INLINE Symmetric<Real> chosen(Mask first, const Symmetric<Real>& A, const Symmetric<Real>& B)
{
    return {hn::IfThenElse(first, A.xx, B.xx), hn::IfThenElse(first, A.yy, B.yy), hn::IfThenElse(first, A.zz, B.zz),
            hn::IfThenElse(first, A.yz, B.yz), hn::IfThenElse(first, A.xz, B.xz), hn::IfThenElse(first, A.xy, B.xy)};
}

/// passElements() for elements of either law: stores forces and gradients, and returns the response. Elements are those
/// of passElements(), with law(), 1 for Neo-Hookean ones.
template <class Real, class Elements, class Other>
HWY_INLINE NeoHookeLanes<Real> passNonlinear(const Elements& elements, const Quaternions<Real>& q, const Other& other)
{
    const Vector<Real> lambda = elements.lambda(), mu = elements.mu();
    const Vector<Real> zero = number<Real>(0), one = number<Real>(1);
    other(0);
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    const Matrix<Real> g = timesTranspose(R, elements.DmInverse());
    const Symmetric<Real> doubled = strainOf(edgesMinusRotated(elements, q), g);
    other(1);
    NeoHookeLanes<Real> law = neoHooke<Real>(lambda, mu, withoutDoubling(doubled));
    const auto isNeoHooke = elements.law() > zero;
    law.m_stress = chosen<Real>(isNeoHooke, law.m_stress, hooke<Real>(lambda, mu, doubled));
    law.m_cofactor = chosen<Real>(isNeoHooke, law.m_cofactor, {one, one, one, zero, zero, zero});
    law.m_bulk = hn::IfThenElse(isNeoHooke, law.m_bulk, lambda);
    law.m_shear = hn::IfThenElse(isNeoHooke, law.m_shear, one);
    other(2);
    const Symmetric<Real> rate = withoutDoubling(strainOf(elements.velocityEdges(), g));
    const Symmetric<Real> viscous =
        combined<Real>(law.m_bulk * contraction(law.m_cofactor, rate), law.m_cofactor, (mu + mu) * law.m_shear, rate);
    const Symmetric<Real> minusStress =
        combined<Real>(hn::Neg(elements.damping()), viscous, hn::Neg(one), law.m_stress);
    elements.storeForces(times(full(minusStress), g));
    elements.storeGradients(g);
    other(3);
    return law;
}

/// Stores the input of an ElementProduct: with g' times sqrt(k) and C' = sqrt(l / k) C, k multiplies all of K', and T
/// is divided by it.
template <class Real, class Elements>
HWY_INLINE void storeTangent(const Elements& elements, const NeoHookeLanes<Real>& law, const Symmetric<Real>& tension)
{
    const Vector<Real> one = number<Real>(1), root = hn::Sqrt(law.m_shear), inverse = one / law.m_shear;
    const Matrix<Real> rows = elements.loadGradients();
    Matrix<Real> g;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) g.m[k % 3][k / 3] = root * rows.m[k / 3][k % 3];
    elements.storeGradients(g);
    elements.storeTension(times<Real>(tension, inverse));
    elements.storeCofactor(times<Real>(law.m_cofactor, hn::Sqrt(law.m_bulk * inverse)));
}

/// P + s C.
template <class Real>
HWY_INLINE Matrix<Real> plusSymmetric(const Matrix<Real>& P, Vector<Real> s, const Symmetric<Real>& C)
{
    const Matrix<Real> all = full(C);
    Matrix<Real> result;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) result.m[k / 3][k % 3] = hn::MulAdd(s, all.m[k / 3][k % 3], P.m[k / 3][k % 3]);
    return result;
}

/// C : H of a symmetric C.
template <class Real>
HWY_INLINE Vector<Real> contraction(const Symmetric<Real>& C, const Matrix<Real>& H)
{
    return dot3(C.xx, H.m[0][0], C.yy, H.m[1][1], C.zz, H.m[2][2]) +
           dot3(C.yz, H.m[1][2] + H.m[2][1], C.xz, H.m[0][2] + H.m[2][0], C.xy, H.m[0][1] + H.m[1][0]);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
