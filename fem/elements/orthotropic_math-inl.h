// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Stresses of general C and changes of stretches (orthotropic_elements.h), several elements at a time. Included once
// for every instruction set.
#if defined(BULLETFEM_ORTHOTROPIC_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_ORTHOTROPIC_MATH_INL_H
#undef BULLETFEM_ORTHOTROPIC_MATH_INL_H
#else
#define BULLETFEM_ORTHOTROPIC_MATH_INL_H
#endif

#include "fem/elements/element_math-inl.h"

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// V D eps of a strain with doubled shears.
template <class Real>
HWY_INLINE Symmetric<Real> stiffnessTimes(const StiffnessBlock<Real>& block, int lane, const Symmetric<Real>& E)
{
    const auto row = [&](int i, int j, int k, int l, int m, int n)
    {
        const Lanes<Real> d;
        const auto& C = block.m_entry;
        return dot3(hn::Load(d, C[i] + lane), E.xx, hn::Load(d, C[j] + lane), E.yy, hn::Load(d, C[k] + lane), E.zz) +
               dot3(hn::Load(d, C[l] + lane), E.yz, hn::Load(d, C[m] + lane), E.xz, hn::Load(d, C[n] + lane), E.xy);
    };
    return {row(0, 1, 2, 3, 4, 5),     row(1, 6, 7, 8, 9, 10),    row(2, 7, 11, 12, 13, 14),
            row(3, 8, 12, 15, 16, 17), row(4, 9, 13, 16, 18, 19), row(5, 10, 14, 17, 19, 20)};
}

template <class Real>
HWY_INLINE Symmetric<Real> loadSymmetricRows(const Real (&entries)[6][kLanes], int lane)
{
    const Lanes<Real> d;
    return {hn::Load(d, entries[0] + lane), hn::Load(d, entries[1] + lane), hn::Load(d, entries[2] + lane),
            hn::Load(d, entries[3] + lane), hn::Load(d, entries[4] + lane), hn::Load(d, entries[5] + lane)};
}

template <class Real>
HWY_INLINE void storeSymmetricRows(const Symmetric<Real>& S, Real (&to)[6][kLanes], int lane)
{
    const Vector<Real> entries[6] = {S.xx, S.yy, S.zz, S.yz, S.xz, S.xy};
    HWY_UNROLL(6)
    for (int k = 0; k < 6; ++k) hn::Store(entries[k], Lanes<Real>(), to[k] + lane);
}

/// sym(H) with doubled shears.
template <class Real>
HWY_INLINE Symmetric<Real> doubledPart(const Matrix<Real>& H)
{
    return {H.m[0][0], H.m[1][1], H.m[2][2], H.m[1][2] + H.m[2][1], H.m[0][2] + H.m[2][0], H.m[0][1] + H.m[1][0]};
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

/// S and (tr(S) I - S)^-1.
template <class Real>
struct StretchLanes
{
    using V = Vector<Real>;
    HWY_INLINE StretchLanes() = default;  // an implicit one would not be compiled for the instruction set

    /// Sets S = I + strain, with doubled shears of the strain.
    HWY_INLINE void find(const Symmetric<Real>& strain)
    {
        const V one = number<Real>(1), half = number<Real>(0.5), minusHalf = number<Real>(-0.5);
        m_stretch = {one + strain.xx,  one + strain.yy,  one + strain.zz,
                     half * strain.yz, half * strain.xz, half * strain.xy};
        const Symmetric<Real>& S = m_stretch;
        const Symmetric<Real> G = {S.yy + S.zz,           S.xx + S.zz,           S.xx + S.yy,
                                   minusHalf * strain.yz, minusHalf * strain.xz, minusHalf * strain.xy};
        const Symmetric<Real> A = adjugate(G);
        const V det = dot3(G.xx, A.xx, G.xy, A.xy, G.xz, A.xz);
        // Sylvester's pivots G.xx, A.zz / G.xx, det / A.zz.
        const V least = hn::Max(number<Real>(kMinPivot) * trace(G), hn::Zero(Lanes<Real>()));
        const auto definite = hn::And(hn::And(G.xx > least, A.zz > least * G.xx), det > least * A.zz);
        m_spin = times<Real>(A, hn::IfThenElseZero(definite, one / det));
    }

    /// The axis w with (tr(S) I - S) w = axl(M - M^T).
    HWY_INLINE void turnOf(const Matrix<Real>& M, V (&w)[3]) const
    {
        const V a = M.m[2][1] - M.m[1][2], b = M.m[0][2] - M.m[2][0], c = M.m[1][0] - M.m[0][1];
        const Symmetric<Real>& G = m_spin;
        w[0] = dot3(G.xx, a, G.xy, b, G.xz, c);
        w[1] = dot3(G.xy, a, G.yy, b, G.yz, c);
        w[2] = dot3(G.xz, a, G.yz, b, G.zz, c);
    }

    /// dS(H) with doubled shears.
    HWY_INLINE Symmetric<Real> change(const Matrix<Real>& H) const
    {
        V w[3];
        turnOf(H, w);
        const Matrix<Real> S = full(m_stretch);
        Matrix<Real> M;  // H - [w]x S
        HWY_UNROLL(3)
        for (int j = 0; j < 3; ++j)
        {
            M.m[0][j] = hn::MulAdd(w[2], S.m[1][j], hn::NegMulAdd(w[1], S.m[2][j], H.m[0][j]));
            M.m[1][j] = hn::MulAdd(w[0], S.m[2][j], hn::NegMulAdd(w[2], S.m[0][j], H.m[1][j]));
            M.m[2][j] = hn::MulAdd(w[1], S.m[0][j], hn::NegMulAdd(w[0], S.m[1][j], H.m[2][j]));
        }
        return doubledPart(M);
    }

    /// stress + rest + W, with W from `rest`.
    HWY_INLINE Matrix<Real> balanced(const Symmetric<Real>& stress, const Symmetric<Real>& rest) const
    {
        V w[3];
        turnOf(times(full(m_stretch), full(rest)), w);
        Matrix<Real> P = full(combined<Real>(number<Real>(1), stress, number<Real>(1), rest));
        P.m[0][1] = P.m[0][1] - w[2], P.m[1][0] = P.m[1][0] + w[2];
        P.m[0][2] = P.m[0][2] + w[1], P.m[2][0] = P.m[2][0] - w[1];
        P.m[1][2] = P.m[1][2] - w[0], P.m[2][1] = P.m[2][1] + w[0];
        return P;
    }

    Symmetric<Real> m_stretch, m_spin;
};

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#endif
