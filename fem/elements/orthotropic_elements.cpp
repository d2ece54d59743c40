// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/orthotropic_elements.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/orthotropic_elements.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

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

template <class Real>
HWY_INLINE void passOrthotropicLanes(const OrthotropicPass<Real>& pass, int b, int lane,
                                     const StagedEdges<double, width<Real>()>& x, const Matrix<Real>& velocityEdges)
{
    const ElementPass<Real>& plain = pass.m_elements;
    const DeformedLanes<Real> elements = {plain.m_elements->m_blocks[b], x, lane};
    const StiffnessBlock<Real>& D = plain.m_elements->m_stiffness[b];
    const Matrix<Real> DmInverse = elements.DmInverse();
    const Quaternions<Real> q = turnedLanes(plain, elements, plain.m_rotation + b * kLanes + lane);
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    const Symmetric<Real> strain = strainInFrameOf(R, times(edgesMinusRotated(elements, q), DmInverse));
    StretchLanes<Real> lanes;
    lanes.find(strain);
    const Matrix<Real> rate = inFrameOf(R, times(velocityEdges, DmInverse));
    const ElementBlock<Real>& block = plain.m_elements->m_blocks[b];
    const Vector<Real> lambda = hn::Load(Lanes<Real>(), block.m_lambdaVolume + lane);
    const Vector<Real> mu = hn::Load(Lanes<Real>(), block.m_muVolume + lane);
    const Vector<Real> one = number<Real>(1), minusOne = number<Real>(-1);
    Symmetric<Real> rest = stiffnessTimes(D, lane, strain);
    if (plain.m_initialStress)
        rest = combined<Real>(one, loadSymmetric(plain.m_initialStress[b].m_entry, lane), one, rest);
    const Symmetric<Real> damped = combined<Real>(number<Real>(plain.m_damping), doubledPart(rate), one, strain);
    const Symmetric<Real> minusStress = hooke<Real>(hn::Neg(lambda), hn::Neg(mu), damped);
    const Symmetric<Real> viscousRest = stiffnessTimes(D, lane, lanes.change(rate));
    const Symmetric<Real> minusRest = combined<Real>(number<Real>(-plain.m_damping), viscousRest, minusOne, rest);
    const Matrix<Real> P = lanes.balanced(minusStress, minusRest);
    storeCorners(times(R, timesTranspose(P, DmInverse)), plain.m_force[b], lane);

    OrthotropicBlock<Real>& out = pass.m_warped[b];
    storeMatrix(R, out.m_rotation, lane);
    const Symmetric<Real> stress = combined<Real>(one, hooke<Real>(lambda, mu, strain), one, rest);
    storeSymmetric(tensionOf(plain.m_tensionFactor, stress), out.m_tension, lane);
    storeSymmetric(lanes.m_stretch, out.m_stretch, lane);
    storeSymmetric(lanes.m_spin, out.m_spin, lane);
}

template <class Real>
void passOrthotropic(const OrthotropicPass<Real>& pass, Range blocks)
{
    const ElementPass<Real>& plain = pass.m_elements;
    StagedEdges<double, width<Real>()> x[2];
    StagedEdges<Real> v[2];
    const auto stage = [&](int b, int lane, int slot)
    {
        x[slot].stage(plain.m_elements->m_blocks[b].m_node + lane, plain.m_x);
        v[slot].stage(plain.m_elements->m_blocks[b].m_node + lane, plain.m_v);
    };
    const auto compute = [&](int b, int lane, int slot)
    { passOrthotropicLanes(pass, b, lane, x[slot], v[slot].load()); };
    forEachVector<Real>(blocks, stage, compute);
}

template <class Real>
void multiplyOrthotropic(const OrthotropicProduct<Real>& product, Range blocks)
{
    const ElementProduct<Real>& plain = product.m_elements;
    const ElementBlocks<Real>& elements = *plain.m_elements;
    const Vector<Real> factor = number<Real>(plain.m_stiffnessFactor);
    StagedEdges<Real> edges[2];
    const auto stage = [&](int b, int lane, int slot)
    { edges[slot].stage(elements.m_blocks[b].m_node + lane, plain.m_p); };
    const auto compute = [&](int b, int lane, int slot)
    {
        const OrthotropicBlock<Real>& warped = product.m_warped[b];
        const Matrix<Real> DmInverse = loadMatrix(elements.m_blocks[b].m_DmInverse, lane);
        const Matrix<Real> R = loadMatrix(warped.m_rotation, lane);
        const Matrix<Real> H = inFrameOf(R, times(edges[slot].load(), DmInverse));
        StretchLanes<Real> lanes;
        lanes.m_stretch = loadSymmetric(warped.m_stretch, lane);
        lanes.m_spin = loadSymmetric(warped.m_spin, lane);
        const ElementBlock<Real>& block = elements.m_blocks[b];
        const Vector<Real> lambda = factor * hn::Load(Lanes<Real>(), block.m_lambdaVolume + lane);
        const Vector<Real> mu = factor * hn::Load(Lanes<Real>(), block.m_muVolume + lane);
        const Symmetric<Real> change = times<Real>(lanes.change(H), factor);
        const Matrix<Real> P = plus(lanes.balanced(hooke<Real>(lambda, mu, doubledPart(H)),
                                                   stiffnessTimes(elements.m_stiffness[b], lane, change)),
                                    times(H, full(loadSymmetric(warped.m_tension, lane))));
        storeCorners(times(R, timesTranspose(P, DmInverse)), plain.m_out[b], lane);
    };
    forEachVector<Real>(blocks, stage, compute);
}

BULLETFEM_KERNEL(passOrthotropic, OrthotropicPass)
BULLETFEM_KERNEL(multiplyOrthotropic, OrthotropicProduct)

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT_KERNEL(passOrthotropic, OrthotropicPass, runOrthotropicPass)
BULLETFEM_EXPORT_KERNEL(multiplyOrthotropic, OrthotropicProduct, runOrthotropicProduct)

}  // namespace bullet_fem
#endif
