// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/elements/element_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/element_pass.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/deformed_edges-inl.h"
#include "fem/elements/positive_part-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// Processors with nothing that Highway knows.
template <class Real>
void passBlocks(const ElementPass<Real>& pass, Range blocks)
{
    scalar::runElementPass(pass, blocks);
}

#else

/// sym(A R^T).
template <class Real>
HWY_INLINE Symmetric<Real> symmetricPart(const Matrix<Real>& A, const Matrix<Real>& R)
{
    const auto entry = [&](int i, int j)
    { return dot3(A.m[i][0], R.m[j][0], A.m[i][1], R.m[j][1], A.m[i][2], R.m[j][2]); };
    const Vector<Real> half = number<Real>(0.5);
    return {entry(0, 0),
            entry(1, 1),
            entry(2, 2),
            half * (entry(1, 2) + entry(2, 1)),
            half * (entry(0, 2) + entry(2, 0)),
            half * (entry(0, 1) + entry(1, 0))};
}

/// 2 mu E + lambda tr(E) I, the Lame constants times the volume.
template <class Real>
HWY_INLINE Symmetric<Real> hooke(Vector<Real> lambda, Vector<Real> mu, const Symmetric<Real>& E)
{
    const Vector<Real> twoMu = mu + mu, pressure = lambda * trace(E);
    return {hn::MulAdd(twoMu, E.xx, pressure),
            hn::MulAdd(twoMu, E.yy, pressure),
            hn::MulAdd(twoMu, E.zz, pressure),
            twoMu * E.yz,
            twoMu * E.xz,
            twoMu * E.xy};
}

/// The elements of a block from `lane` on, as many as a vector has lanes. Strains and stresses are those of the world's
/// frame, R E R^T = sym(F R^T) - I: forces and tension then need R by g' = R g alone.
template <class Real>
struct PassLanes
{
    const ElementPass<Real>& m_pass;
    const DeformedEdges<Real> m_x;
    const StagedEdges<Real>& m_v;
    int m_block, m_lane;

    HWY_INLINE const ElementBlock<Real>& block() const { return m_pass.m_elements->m_blocks[m_block]; }
    HWY_INLINE Quaternion* rotations() const { return m_pass.m_rotation + m_block * kLanes + m_lane; }

    HWY_INLINE Matrix<Real> deformationGradient() const
    {
        return times(m_x.edges(), loadMatrix(block().m_DmInverse, m_lane));
    }

    /// All that follows from the rotations.
    HWY_INLINE void run(const Quaternions<Real>& q) const
    {
        const Lanes<Real> d;
        const Matrix<Real> DmInverse = loadMatrix(block().m_DmInverse, m_lane);
        const Vector<Real> lambda = hn::Load(d, block().m_lambdaVolume + m_lane);
        const Vector<Real> mu = hn::Load(d, block().m_muVolume + m_lane);
        const Matrix<Real> R = toMatrix(q), g = timesTranspose(R, DmInverse);  // column a is R g_a
        // F - R instead of F: sym(F R^T) - I would lose strains to rounding.
        const Matrix<Real> FminusR = times(m_x.minusRotated(q, block().m_Dm, m_lane), DmInverse);
        const Symmetric<Real> elastic = hooke<Real>(lambda, mu, symmetricPart(FminusR, R));
        const Matrix<Real> Fdot = times(m_v.load(), DmInverse);
        const Symmetric<Real> viscous = hooke<Real>(lambda, mu, symmetricPart(Fdot, R));

        const Symmetric<Real> minusStress =
            combined<Real>(number<Real>(-1), elastic, number<Real>(-m_pass.m_damping), viscous);
        storeCorners(times(full(minusStress), g), m_pass.m_force[m_block], m_lane);
        storeWarped(g, lambda, mu);
        storeTension(elastic);
    }

    HWY_INLINE void storeWarped(const Matrix<Real>& g, Vector<Real> lambda, Vector<Real> mu) const
    {
        const Lanes<Real> d;
        WarpedBlock<Real>& out = m_pass.m_warped[m_block];
        const Vector<Real> factor = number<Real>(m_pass.m_stiffnessFactor);
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) hn::Store(g.m[k % 3][k / 3], d, out.m_gradient[k] + m_lane);
        hn::Store(factor * lambda, d, out.m_lambda + m_lane);
        hn::Store(factor * mu, d, out.m_mu + m_lane);
    }

    HWY_INLINE void storeTension(const Symmetric<Real>& elastic) const
    {
        const Lanes<Real> d;
        const Vector<Real> factor = number<Real>(m_pass.m_tensionFactor), zero = number<Real>(0);
        Symmetric<Real> T = {zero, zero, zero, zero, zero, zero};
        if (m_pass.m_tensionFactor != 0) T = positivePart(elastic);
        const Vector<Real> entries[6] = {T.xx, T.yy, T.zz, T.yz, T.xz, T.xy};
        HWY_UNROLL(6)
        for (int k = 0; k < 6; ++k) hn::Store(factor * entries[k], d, m_pass.m_warped[m_block].m_tension[k] + m_lane);
    }
};

template <class Real>
HWY_INLINE void passBlocks(const ElementPass<Real>& pass, Range blocks)
{
    constexpr int kN = width<Real>(), kVectors = kLanes / kN;  // of a block
    StagedEdges<double, kN> x[kBatch];
    StagedEdges<Real> v[kBatch];
    Matrix<Real> F[kBatch];
    Quaternions<Real> q[kBatch];
    const auto lanes = [&](int k, int i) {
        return PassLanes<Real>{pass, {x[i]}, v[i], (k + i) / kVectors, (k + i) % kVectors * kN};
    };

    const int end = blocks.m_end * kVectors;
    for (int k = blocks.m_begin * kVectors; k < end; k += kBatch)
    {
        const int count = HWY_MIN(kBatch, end - k);
        for (int i = 0; i < count; ++i)
        {
            const PassLanes<Real> l = lanes(k, i);
            x[i].stage(l.block().m_node + l.m_lane, pass.m_x);
            v[i].stage(l.block().m_node + l.m_lane, pass.m_v);
        }
        for (int i = 0; i < count; ++i)
        {
            F[i] = lanes(k, i).deformationGradient();
            q[i] = loadQuaternions(lanes(k, i).rotations(), Real());
        }
        polarRotations(F, count, q);
        for (int i = 0; i < count; ++i) storeQuaternions(q[i], lanes(k, i).rotations());
        for (int i = 0; i < count; ++i) lanes(k, i).run(q[i]);
    }
}

#endif

void elementPassFloat(const ElementPass<float>& pass, Range blocks)
{
    passBlocks(pass, blocks);
}

void elementPassDouble(const ElementPass<double>& pass, Range blocks)
{
    passBlocks(pass, blocks);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(elementPassFloat);
HWY_EXPORT(elementPassDouble);

template <>
void runElementPass(const ElementPass<float>& pass, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(elementPassFloat)(pass, blocks);
}

template <>
void runElementPass(const ElementPass<double>& pass, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(elementPassDouble)(pass, blocks);
}

}  // namespace bullet_fem
#endif
