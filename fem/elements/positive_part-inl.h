// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Positive spectral parts of several symmetric matrices at a time. Included once for every instruction set.
#if defined(BULLETFEM_POSITIVE_PART_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_POSITIVE_PART_INL_H
#undef BULLETFEM_POSITIVE_PART_INL_H
#else
#define BULLETFEM_POSITIVE_PART_INL_H
#endif

#include <type_traits>

#include "fem/elements/lanes-inl.h"

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// a A + b B.
template <class Real>
HWY_INLINE Symmetric<Real> combined(Vector<Real> a, const Symmetric<Real>& A, Vector<Real> b, const Symmetric<Real>& B)
{
    return {hn::MulAdd(a, A.xx, b * B.xx), hn::MulAdd(a, A.yy, b * B.yy), hn::MulAdd(a, A.zz, b * B.zz),
            hn::MulAdd(a, A.yz, b * B.yz), hn::MulAdd(a, A.xz, b * B.xz), hn::MulAdd(a, A.xy, b * B.xy)};
}

/// A + s I.
template <class Real>
HWY_INLINE Symmetric<Real> shifted(const Symmetric<Real>& A, Vector<Real> s)
{
    return {A.xx + s, A.yy + s, A.zz + s, A.yz, A.xz, A.xy};
}

template <class Real>
HWY_INLINE Vector<Real> trace(const Symmetric<Real>& A)
{
    return A.xx + A.yy + A.zz;
}

template <class Real>
HWY_INLINE Symmetric<Real> adjugate(const Symmetric<Real>& A)
{
    return {hn::MulSub(A.yy, A.zz, A.yz * A.yz), hn::MulSub(A.xx, A.zz, A.xz * A.xz),
            hn::MulSub(A.xx, A.yy, A.xy * A.xy), hn::MulSub(A.xz, A.xy, A.xx * A.yz),
            hn::MulSub(A.xy, A.yz, A.yy * A.xz), hn::MulSub(A.yz, A.xz, A.zz * A.xy)};
}

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

template <class Real>
HWY_INLINE Symmetric<Real> times(const Symmetric<Real>& S, Vector<Real> s)
{
    return {S.xx * s, S.yy * s, S.zz * s, S.yz * s, S.xz * s, S.xy * s};
}

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

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#endif
