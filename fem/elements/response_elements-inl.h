// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Elements whose law is evaluated in every step, by themselves and in patches of mean dilatation. Included once for
// every instruction set.
#if defined(BULLETFEM_RESPONSE_ELEMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_RESPONSE_ELEMENTS_INL_H
#undef BULLETFEM_RESPONSE_ELEMENTS_INL_H
#else
#define BULLETFEM_RESPONSE_ELEMENTS_INL_H
#endif

#include "fem/elements/element_math-inl.h"
#include "fem/elements/single_responses.h"
#include "fem/laws/neo_hooke-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

template <class Real>
HWY_INLINE Symmetric<Real> unitMatrixOf()
{
    const Vector<Real> zero = number<Real>(0), one = number<Real>(1);
    return {one, one, one, zero, zero, zero};
}

/// Replaces the responses of lanes from `first` on whose laws are evaluated one element at a time.
template <class Real>
HWY_INLINE void respondSingly(const ElementBlocks<Real>& all, const double* history, int first, Vector<Real> lambda,
                              Vector<Real> pressure, const Symmetric<Real>& e, ResponseLanes<Real>& law)
{
    if (all.m_single.empty()) return;
    const Lanes<Real> d;
    SingleResponses<Real> single;
    storeSymmetric(e, single.m_strain, 0);
    hn::Store(lambda, d, single.m_lambda);
    hn::Store(pressure, d, single.m_pressure);
    storeSymmetric(law.m_stress, single.m_stress, 0);
    storeSymmetric(law.m_cofactor, single.m_cofactor, 0);
    hn::Store(law.m_bulk, d, single.m_bulk);
    hn::Store(law.m_shear, d, single.m_shear);
    single.respond(all, history, first, width<Real>());
    law.m_stress = loadSymmetric(single.m_stress, 0);
    law.m_cofactor = loadSymmetric(single.m_cofactor, 0);
    law.m_bulk = hn::Load(d, single.m_bulk);
    law.m_shear = hn::Load(d, single.m_shear);
}

/// Responses of a vector of elements to a strain with doubled shears. Elements are those of passElements(), with law(),
/// numbers of LaneLaw, and respondOneByOne(). lambda and pressure are those of LawPoint, times the volume.
template <class Real, class Elements>
HWY_INLINE ResponseLanes<Real> respond(const Elements& elements, Vector<Real> lambda, Vector<Real> pressure,
                                       const Symmetric<Real>& doubled)
{
    const Vector<Real> mu = elements.mu(), one = number<Real>(1);
    const Symmetric<Real> e = withoutDoubling(doubled);
    ResponseLanes<Real> law = neoHooke<Real>(lambda, mu, pressure, e);
    const auto isNeoHooke = hn::Eq(elements.law(), number<Real>(static_cast<double>(LaneLaw::neoHooke)));
    const Symmetric<Real> linear = hookeUnder<Real>(hn::MulAdd(lambda, trace(doubled), pressure), mu, doubled);
    law.m_stress = chosen<Real>(isNeoHooke, law.m_stress, linear);
    law.m_cofactor = chosen<Real>(isNeoHooke, law.m_cofactor, unitMatrixOf<Real>());
    law.m_bulk = hn::IfThenElse(isNeoHooke, law.m_bulk, lambda);
    law.m_shear = hn::IfThenElse(isNeoHooke, law.m_shear, one);
    elements.respondOneByOne(lambda, pressure, e, law);
    return law;
}

/// The part of ElementPass::m_damping times the tangent, l C (C : rate) + 2 k mu rate; shears of `rate` not doubled.
template <class Real>
HWY_INLINE Symmetric<Real> viscousStress(const ResponseLanes<Real>& law, Vector<Real> mu, const Symmetric<Real>& rate)
{
    return combined<Real>(law.m_bulk * contraction(law.m_cofactor, rate), law.m_cofactor, (mu + mu) * law.m_shear,
                          rate);
}

/// passElements() for elements without patches: stores forces and gradients, and returns the response.
template <class Real, class Elements, class Other>
HWY_INLINE ResponseLanes<Real> passResponses(const Elements& elements, const Quaternions<Real>& q, const Other& other)
{
    other(0);
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    const Matrix<Real> g = timesTranspose(R, elements.DmInverse());
    const Symmetric<Real> doubled = strainOf(edgesMinusRotated(elements, q), g);
    other(1);
    const ResponseLanes<Real> law = respond<Real>(elements, elements.lambda(), number<Real>(0), doubled);
    other(2);
    const Symmetric<Real> rate = withoutDoubling(strainOf(elements.velocityEdges(), g));
    const Symmetric<Real> viscous = viscousStress<Real>(law, elements.mu(), rate);
    const Symmetric<Real> minusStress =
        combined<Real>(hn::Neg(elements.damping()), viscous, number<Real>(-1), law.m_stress);
    elements.storeForces(times(full(minusStress), g));
    elements.storeGradients(g);
    other(3);
    return law;
}

/// Stores the input of an ElementProduct (TangentBlock).
template <class Real, class Elements>
HWY_INLINE void storeTangent(const Elements& elements, const ResponseLanes<Real>& law, Vector<Real> patchBulk,
                             const Symmetric<Real>& tension)
{
    const Vector<Real> one = number<Real>(1), root = hn::Sqrt(law.m_shear), inverse = one / law.m_shear;
    const Matrix<Real> rows = elements.loadGradients();
    Matrix<Real> g;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) g.m[k % 3][k / 3] = root * rows.m[k / 3][k % 3];
    elements.storeGradients(g);
    elements.storeTension(times<Real>(tension, inverse));
    elements.storeTangentBlock(times<Real>(law.m_cofactor, root * inverse), law.m_bulk, patchBulk);
}

/// The elements of a patch, as PatchStrains: the part of lambda is V_p lambda gamma(v) with the mean v of volume
/// changes over the patch (VolumeFunction), the rest of each element its own. Hooke's law has v = tr(e) and shares its
/// whole pressure, as in PatchStrains; the others have v = J - 1.
template <class Real>
struct PatchResponses
{
    using V = Vector<Real>;
    HWY_INLINE PatchResponses() : m_volumeChange(number<Real>(0)), m_rate(m_volumeChange) {}

    /// Adds element k of the patch. Stores its gradients.
    template <class Elements>
    HWY_INLINE void add(int k, const Elements& elements, const Quaternions<Real>& q)
    {
        const Matrix<Real> R = toMatrix(q, number<Real>(2));
        const Matrix<Real> g = timesTranspose(R, elements.DmInverse());
        m_strain[k] = strainOf(edgesMinusRotated(elements, q), g);
        m_strainRate[k] = withoutDoubling(strainOf(elements.velocityEdges(), g));
        elements.storeGradients(g);
        const Symmetric<Real> e = withoutDoubling(m_strain[k]), adjugateOfE = adjugate(e);
        const V tr = trace(e), zero = number<Real>(0), one = number<Real>(1);
        const V det = dot3(e.xx, adjugateOfE.xx, e.xy, adjugateOfE.xy, e.xz, adjugateOfE.xz);
        const auto hasRatio = isOfRatio(elements);
        const V change = hn::IfThenElse(hasRatio, tr + trace(adjugateOfE) + det, tr);
        const Symmetric<Real> cofactor = shifted<Real>(combined<Real>(one, adjugateOfE, number<Real>(-1), e), one + tr);
        const V rate = contraction(chosen<Real>(hasRatio, cofactor, unitMatrixOf<Real>()), m_strainRate[k]);
        const V share = elements.share();
        m_volumeChange = hn::MulAdd(share, change, k == 0 ? zero : m_volumeChange);
        m_rate = hn::MulAdd(share, rate, k == 0 ? zero : m_rate);
    }

    /// Stores the forces of element k and returns its stress.
    template <class Elements>
    HWY_INLINE Symmetric<Real> finish(int k, const Elements& elements)
    {
        const V lambda = elements.lambda(), mu = elements.mu(), zero = number<Real>(0), one = number<Real>(1);
        const auto hasRatio = isOfRatio(elements);
        const auto isLinear = hn::Lt(elements.law(), one);
        const V least = number<Real>(kMinVolumeRatio - 1), half = number<Real>(0.5);
        const V above = hn::Max(m_volumeChange, least), below = m_volumeChange - above, inverse = one / (one + above);
        const V curvature = half * hn::MulAdd(inverse, inverse, one);
        const V slope = hn::MulAdd(curvature, below, above * hn::MulAdd(half, above, one) * inverse);
        const V bulk = hn::MulAdd(number<Real>(2.0 / 3), mu, lambda);
        const V shared = hn::IfThenElse(isLinear, bulk, hn::IfThenElse(hasRatio, lambda, zero));
        m_patchBulk = shared * hn::IfThenElse(hasRatio, curvature, one);
        const V pressure = shared * hn::IfThenElse(hasRatio, slope, m_volumeChange);
        m_law = respond<Real>(elements, lambda - shared, pressure, m_strain[k]);
        const Symmetric<Real> viscous = combined<Real>(one, viscousStress<Real>(m_law, mu, m_strainRate[k]),
                                                       m_patchBulk * m_rate, m_law.m_cofactor);
        const Symmetric<Real> minusStress =
            combined<Real>(hn::Neg(elements.damping()), viscous, number<Real>(-1), m_law.m_stress);
        elements.storeForces(timesTranspose(full(minusStress), elements.loadGradients()));
        return m_law.m_stress;
    }

    /// Stores the input of an ElementProduct for the element that was finished last.
    template <class Elements>
    HWY_INLINE void storeTension(const Elements& elements, const Symmetric<Real>& tension) const
    {
        storeTangent(elements, m_law, m_patchBulk, tension);
    }

    Symmetric<Real> m_strain[ElementPatches::kMax];  // with doubled shears

private:
    template <class Elements>
    HWY_INLINE hn::Mask<Lanes<Real>> isOfRatio(const Elements& elements) const
    {
        const V law = elements.law();
        return hn::And(law > number<Real>(static_cast<double>(LaneLaw::linear)),
                       law < number<Real>(static_cast<double>(LaneLaw::singleAllAtOnce)));
    }

    Symmetric<Real> m_strainRate[ElementPatches::kMax];
    V m_volumeChange, m_rate, m_patchBulk;
    ResponseLanes<Real> m_law;
};

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

/// K' H of elements from `lane` on of block b; `mean` is the patch's mean of C' : H.
template <class Real>
HWY_INLINE Matrix<Real> tangentTimes(const TangentBlock<Real>& tangent, const Symmetric<Real>& tension, int lane,
                                     Vector<Real> factor, Vector<Real> mu, Vector<Real> mean, const Matrix<Real>& H)
{
    const Lanes<Real> d;
    const Symmetric<Real> C = loadSymmetric(tangent.m_cofactor, lane);
    const Vector<Real> own = hn::Load(d, tangent.m_bulk + lane) * contraction(C, H);
    const Vector<Real> all = hn::MulAdd(hn::Load(d, tangent.m_patchBulk + lane), mean, own);
    return plusSymmetric<Real>(warpedStress<Real>(hn::Zero(d), factor * mu, tension, H), factor * all, C);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
