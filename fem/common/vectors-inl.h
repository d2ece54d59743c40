// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Small matrices whose entries are SIMD vectors, one lane per element. Included once for every instruction set.
#if defined(BULLETFEM_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_VECTORS_INL_H
#undef BULLETFEM_VECTORS_INL_H
#else
#define BULLETFEM_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include "fem/common/lane_count.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
using Lanes = hn::CappedTag<Real, kLanes>;

template <class Real>
using Vector = hn::Vec<Lanes<Real>>;

/// Number of elements processed at a time.
template <class Real>
constexpr int width()
{
    return static_cast<int>(hn::MaxLanes(Lanes<Real>()));
}

template <class Real>
HWY_INLINE Vector<Real> number(double value)
{
    return hn::Set(Lanes<Real>(), static_cast<Real>(value));
}

/// A 3x3 matrix. Constructors in this file are explicit in the code because implicit ones would be compiled for the
/// baseline processor, into which GCC does not inline NEON. A type with one is no aggregate from C++20 on, so each has
/// two.
template <class Real>
struct Matrix
{
    HWY_INLINE Matrix() = default;
    HWY_INLINE Matrix(const Vector<Real> (&rows)[3][3])
    {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[i][j] = rows[i][j];
    }

    Vector<Real> m[3][3];
};

/// A symmetric 3x3 matrix.
template <class Real>
struct Symmetric
{
    using V = Vector<Real>;
    HWY_INLINE Symmetric() = default;
    HWY_INLINE Symmetric(V sxx, V syy, V szz, V syz, V sxz, V sxy)
        : xx(sxx), yy(syy), zz(szz), yz(syz), xz(sxz), xy(sxy)
    {
    }

    V xx, yy, zz, yz, xz, xy;
};

/// a0 b0 + a1 b1 + a2 b2.
template <class V>
HWY_INLINE V dot3(V a0, V b0, V a1, V b1, V a2, V b2)
{
    return hn::MulAdd(a2, b2, hn::MulAdd(a1, b1, hn::Mul(a0, b0)));
}

/// A B.
template <class Real>
HWY_INLINE Matrix<Real> times(const Matrix<Real>& A, const Matrix<Real>& B)
{
    Matrix<Real> C;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) C.m[i][j] = dot3(A.m[i][0], B.m[0][j], A.m[i][1], B.m[1][j], A.m[i][2], B.m[2][j]);
    return C;
}

/// A B^T.
template <class Real>
HWY_INLINE Matrix<Real> timesTranspose(const Matrix<Real>& A, const Matrix<Real>& B)
{
    Matrix<Real> C;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) C.m[i][j] = dot3(A.m[i][0], B.m[j][0], A.m[i][1], B.m[j][1], A.m[i][2], B.m[j][2]);
    return C;
}

template <class Real>
HWY_INLINE Matrix<Real> plus(const Matrix<Real>& A, const Matrix<Real>& B)
{
    Matrix<Real> C;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) C.m[k / 3][k % 3] = A.m[k / 3][k % 3] + B.m[k / 3][k % 3];
    return C;
}

template <class Real>
HWY_INLINE Symmetric<Real> plus(const Symmetric<Real>& A, const Symmetric<Real>& B)
{
    return {A.xx + B.xx, A.yy + B.yy, A.zz + B.zz, A.yz + B.yz, A.xz + B.xz, A.xy + B.xy};
}

/// The symmetric matrix as a full one.
template <class Real>
HWY_INLINE Matrix<Real> full(const Symmetric<Real>& S)
{
    return {{{S.xx, S.xy, S.xz}, {S.xy, S.yy, S.yz}, {S.xz, S.yz, S.zz}}};
}

template <class Real>
HWY_INLINE Matrix<Real> loadMatrix(const Real (*entries)[kLanes], int lane)
{
    const Lanes<Real> d;
    Matrix<Real> A;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) A.m[k / 3][k % 3] = hn::Load(d, entries[k] + lane);
    return A;
}

template <class Real>
HWY_INLINE void storeMatrix(const Matrix<Real>& A, Real (*entries)[kLanes], int lane)
{
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) hn::Store(A.m[k / 3][k % 3], Lanes<Real>(), entries[k] + lane);
}

template <class Real>
HWY_INLINE Symmetric<Real> loadSymmetric(const Real (&entries)[6][kLanes], int lane)
{
    const Lanes<Real> d;
    return {hn::Load(d, entries[0] + lane), hn::Load(d, entries[1] + lane), hn::Load(d, entries[2] + lane),
            hn::Load(d, entries[3] + lane), hn::Load(d, entries[4] + lane), hn::Load(d, entries[5] + lane)};
}

template <class Real>
HWY_INLINE void storeSymmetric(const Symmetric<Real>& S, Real (&to)[6][kLanes], int lane)
{
    const Vector<Real> entries[6] = {S.xx, S.yy, S.zz, S.yz, S.xz, S.xy};
    HWY_UNROLL(6)
    for (int k = 0; k < 6; ++k) hn::Store(entries[k], Lanes<Real>(), to[k] + lane);
}

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

template <class Real>
HWY_INLINE Symmetric<Real> times(const Symmetric<Real>& S, Vector<Real> s)
{
    return {S.xx * s, S.yy * s, S.zz * s, S.yz * s, S.xz * s, S.xy * s};
}

/// A : B of symmetric matrices.
template <class Real>
HWY_INLINE Vector<Real> contraction(const Symmetric<Real>& A, const Symmetric<Real>& B)
{
    return hn::MulAdd(number<Real>(2), dot3(A.yz, B.yz, A.xz, B.xz, A.xy, B.xy),
                      dot3(A.xx, B.xx, A.yy, B.yy, A.zz, B.zz));
}

template <class Real, class Mask>
HWY_INLINE Symmetric<Real> chosen(Mask first, const Symmetric<Real>& A, const Symmetric<Real>& B)
{
    return {hn::IfThenElse(first, A.xx, B.xx), hn::IfThenElse(first, A.yy, B.yy), hn::IfThenElse(first, A.zz, B.zz),
            hn::IfThenElse(first, A.yz, B.yz), hn::IfThenElse(first, A.xz, B.xz), hn::IfThenElse(first, A.xy, B.xy)};
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
