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
#include "fem/laws/hooke-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// Lower bound of divisors that are of order one or less, as for a matrix with entries of at most 1.
template <class Real>
HWY_INLINE Vector<Real> tinyNumber()
{
    return number<Real>(std::is_same<Real, float>::value ? 1e-30 : 1e-100);
}

/// S = m_size U, with entries of U at most 1; U = A + tr(U) / 3 I; m_value is an eigenvalue of A, m_inverse 1 / m_size.
template <class Real>
struct FarEigenvalue
{
    HWY_INLINE FarEigenvalue() = default;  // an implicit one would not be compiled for the instruction set
    HWY_INLINE FarEigenvalue(Vector<Real> size, Vector<Real> inverse, Vector<Real> value)
        : m_size(size), m_inverse(inverse), m_value(value)
    {
    }

    Vector<Real> m_size, m_inverse, m_value;
};

/// The extreme eigenvalue (largest or smallest) farther from the middle one. With p^2 = |A|^2 / 6 and r = det A / (2
/// p^3), it is 2 p c sign(r) where 4 c^3 - 3 c = |r|, c in [cos 30, 1] (that is c = cos(acos(|r|) / 3)); no other
/// eigenvalue is within 1.7 p.
template <class Real>
HWY_INLINE FarEigenvalue<Real> farEigenvalue(const Symmetric<Real>& S)
{
    using V = Vector<Real>;
    constexpr bool kSingle = std::is_same<Real, float>::value;
    const V tiny = tinyNumber<Real>(), two = number<Real>(2), three = number<Real>(3);

    const V diagonal = hn::Max(hn::Max(hn::Abs(S.xx), hn::Abs(S.yy)), hn::Abs(S.zz));
    const V others = hn::Max(hn::Max(hn::Abs(S.yz), hn::Abs(S.xz)), hn::Abs(S.xy));
    const V size = hn::Max(hn::Max(diagonal, others), number<Real>(1e-35)), inverse = number<Real>(1) / size;
    const Symmetric<Real> U = times<Real>(S, inverse);
    const Symmetric<Real> A = shifted<Real>(U, hn::Neg(number<Real>(1.0 / 3) * trace(U)));
    const V squares = dot3(A.xx, A.xx, A.yy, A.yy, A.zz, A.zz);
    const V products = dot3(A.yz, A.yz, A.xz, A.xz, A.xy, A.xy);
    const V p2 = number<Real>(1.0 / 6) * hn::MulAdd(two, products, squares), p = hn::Sqrt(p2);
    const V det = dot3(A.xx, hn::MulSub(A.yy, A.zz, A.yz * A.yz), A.xy, hn::MulSub(A.yz, A.xz, A.zz * A.xy), A.xz,
                       hn::MulSub(A.xy, A.yz, A.yy * A.xz));
    const V r = hn::Min(number<Real>(1), hn::Abs(det) / hn::MulAdd(two * p, p2, tiny));
    // Newton's iteration from a cubic approximation: its error of 3e-5 becomes 1e-9, then 1e-17.
    V c = hn::MulAdd(
        r,
        hn::MulAdd(r, hn::MulAdd(r, number<Real>(0.0093196838974819209), number<Real>(-0.040691197422887695)),
                   number<Real>(0.16533035022084541)),
        number<Real>(0.86606632953319174));
    HWY_UNROLL(2)
    for (int k = 0; k < (kSingle ? 1 : 2); ++k)
        c = hn::MulAdd(number<Real>(8) * c, c * c, r) / hn::MulSub(number<Real>(12) * c, c, three);
    return {size, inverse, hn::CopySign(two * p * c, det)};
}

/// factor times S with its negative eigenvalues set to zero, by splitting off the isolated eigenvalue e of S; accurate
/// to rounding of the largest entry of S also for equal eigenvalues. As e is isolated, adj(A - (e - tr(A) / 3) I) over
/// its trace is N = v v^T to rounding; if S is a multiple of I, N is 0 or arbitrary. The rest M = S - e N has
/// eigenvalues e1 >= e2 besides 0, with sum T = tr(M) and product D, the sum of the principal minors. With different
/// signs (D < 0) they are distinct, and M+ = e1 (M - e2 (I - N)) / (e1 - e2); with equal signs M+ is M or 0. So S+ = k
/// S + (max(e, 0) - k (e - e2)) N - k e2 I.
template <class Real>
HWY_INLINE Symmetric<Real> positivePart(Vector<Real> factor, const Symmetric<Real>& S, const FarEigenvalue<Real>& far)
{
    using V = Vector<Real>;
    const V zero = number<Real>(0), one = number<Real>(1), half = number<Real>(0.5);
    const Symmetric<Real> U = times<Real>(S, far.m_inverse);
    const V mean = number<Real>(1.0 / 3) * trace(U), e = mean + far.m_value;
    const Symmetric<Real> A = shifted<Real>(U, hn::Neg(mean)), N = adjugate(shifted<Real>(A, hn::Neg(far.m_value)));
    const V share = one / hn::Max(trace(N), tinyNumber<Real>());  // factor from N to v v^T
    const Symmetric<Real> M = combined<Real>(one, U, hn::Neg(e * share), N);

    const V T = trace(M), D = trace(adjugate(M));
    const auto mixed = D < zero;
    const V root = hn::Sqrt(hn::MulAdd(half * T, half * T, hn::Max(zero, hn::Neg(D))));
    const V e1 = hn::Max(zero, hn::MulAdd(half, T, root)), e2 = hn::IfThenElseZero(mixed, hn::MulSub(half, T, root));
    const V k = hn::IfThenElse(mixed, e1 / (root + root), hn::IfThenElseZero(T > zero, one));

    const V onN = share * hn::NegMulAdd(k, e - e2, hn::Max(zero, e)), onI = k * e2;
    const V scale = factor * far.m_size;
    return shifted<Real>(combined<Real>(factor * k, S, scale * onN, N), hn::Neg(scale * onI));
}

/// sym(A) with doubled shears, A = entry(i, j).
template <class Real, class Entry>
HWY_INLINE Symmetric<Real> doubledPart(const Entry& entry)
{
    return {entry(0, 0),
            entry(1, 1),
            entry(2, 2),
            entry(1, 2) + entry(2, 1),
            entry(0, 2) + entry(2, 0),
            entry(0, 1) + entry(1, 0)};
}

/// sym(H) with doubled shears.
template <class Real>
HWY_INLINE Symmetric<Real> doubledPart(const Matrix<Real>& H)
{
    return doubledPart<Real>([&](int i, int j) { return H.m[i][j]; });
}

/// R^T A.
template <class Real>
HWY_INLINE Matrix<Real> inFrameOf(const Matrix<Real>& R, const Matrix<Real>& A)
{
    Matrix<Real> C;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) C.m[i][j] = dot3(R.m[0][i], A.m[0][j], R.m[1][i], A.m[1][j], R.m[2][i], A.m[2][j]);
    return C;
}

/// The strain sym(A B^T) with doubled shears.
template <class Real>
HWY_INLINE Symmetric<Real> strainOf(const Matrix<Real>& A, const Matrix<Real>& B)
{
    return doubledPart<Real>([&](int i, int j)
                             { return dot3(A.m[i][0], B.m[j][0], A.m[i][1], B.m[j][1], A.m[i][2], B.m[j][2]); });
}

/// sym(R^T A) with doubled shears.
template <class Real>
HWY_INLINE Symmetric<Real> strainInFrameOf(const Matrix<Real>& R, const Matrix<Real>& A)
{
    return doubledPart<Real>([&](int i, int j)
                             { return dot3(R.m[0][i], A.m[0][j], R.m[1][i], A.m[1][j], R.m[2][i], A.m[2][j]); });
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
    HWY_INLINE PatchStrains() : m_dilatation(number<Real>(0)), m_dampedDilatation(m_dilatation) {}

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

    /// Stores the tension of an element.
    template <class Elements>
    HWY_INLINE void storeTension(const Elements& elements, const Symmetric<Real>& tension) const
    {
        elements.storeTension(tension);
    }

    Symmetric<Real> m_strain[ElementPatches::kMax], m_damped[ElementPatches::kMax];
    Vector<Real> m_dilatation, m_dampedDilatation;
};

/// B = I + strain with the matrix (tr(B) I - B)^-1 of its spins, as adjugate and inverse determinant; this is zero
/// unless all pivots exceed kMinPivot of the trace.
template <class Real>
struct SpinMatrix
{
    /// The strain has doubled shears.
    HWY_INLINE explicit SpinMatrix(const Symmetric<Real>& strain)
    {
        const Vector<Real> one = number<Real>(1), half = number<Real>(0.5), minusHalf = number<Real>(-0.5);
        m_stretch = {one + strain.xx,  one + strain.yy,  one + strain.zz,
                     half * strain.yz, half * strain.xz, half * strain.xy};
        const Symmetric<Real>& B = m_stretch;
        const Symmetric<Real> H = {B.yy + B.zz,           B.xx + B.zz,           B.xx + B.yy,
                                   minusHalf * strain.yz, minusHalf * strain.xz, minusHalf * strain.xy};
        const Symmetric<Real> A = m_adjugate = adjugate(H);
        const Vector<Real> det = dot3(H.xx, A.xx, H.xy, A.xy, H.xz, A.xz);
        // Sylvester's pivots H.xx, A.zz / H.xx, det / A.zz.
        const Vector<Real> least = hn::Max(number<Real>(kMinPivot) * trace(H), hn::Zero(Lanes<Real>()));
        const auto definite = hn::And(hn::And(H.xx > least, A.zz > least * H.xx), det > least * A.zz);
        m_inverse = hn::IfThenElseZero(definite, one / det);
    }

    Symmetric<Real> m_stretch, m_adjugate;
    Vector<Real> m_inverse;
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

#endif
