// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Elements whose stress does not have the axes of their strain: rotation, stretch and its change, general C. Included
// once for every instruction set.
#if defined(BULLETFEM_STRETCH_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_STRETCH_LANES_INL_H
#undef BULLETFEM_STRETCH_LANES_INL_H
#else
#define BULLETFEM_STRETCH_LANES_INL_H
#endif

#include "fem/elements/element_math-inl.h"

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

/// S and (tr(S) I - S)^-1.
template <class Real>
struct StretchLanes
{
    using V = Vector<Real>;
    HWY_INLINE StretchLanes() = default;  // an implicit one would not be compiled for the instruction set

    /// Sets S = I + strain, with doubled shears of the strain.
    HWY_INLINE void find(const Symmetric<Real>& strain)
    {
        const SpinMatrix<Real> spin(strain);
        m_stretch = spin.m_stretch;
        m_spin = times<Real>(spin.m_adjugate, spin.m_inverse);
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

/// Updates the rotations of a vector of elements to the present positions and returns them.
template <class Real>
HWY_INLINE Quaternions<Real> turnedLanes(const ElementPass<Real>& pass, const DeformedLanes<Real>& elements,
                                         Quaternion* rotation)
{
    Quaternions<Real> q = loadQuaternions(rotation, Real());
    if (pass.m_isRotated) return q;
    const Matrix<Real> F = times(roundedEdges<Real>(elements), elements.DmInverse());
    polarRotations(&F, 1, &q);
    storeQuaternions(q, rotation);
    return q;
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
