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

#include "fem/laws/hooke-inl.h"
#include "fem/laws/neo_hooke.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// The law's response to a strain e whose shears are not doubled, with the pressure of mean dilatation.
template <class Real>
HWY_INLINE ResponseLanes<Real> neoHooke(Vector<Real> lambda, Vector<Real> mu, Vector<Real> pressure,
                                        const Symmetric<Real>& e)
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
    const V q = hn::MulAdd(curvature, below, slope) + pressure;

    ResponseLanes<Real> result;
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

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
