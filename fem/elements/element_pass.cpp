// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/elements/element_pass.h"

#include "fem/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/element_pass.cpp"
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

/// The strain sym(A B^T), shears doubled.
template <class Real>
HWY_INLINE Symmetric<Real> strainOf(const Matrix<Real>& A, const Matrix<Real>& B)
{
    const auto entry = [&](int i, int j)
    { return dot3(A.m[i][0], B.m[j][0], A.m[i][1], B.m[j][1], A.m[i][2], B.m[j][2]); };
    return {entry(0, 0),
            entry(1, 1),
            entry(2, 2),
            entry(1, 2) + entry(2, 1),
            entry(0, 2) + entry(2, 0),
            entry(0, 1) + entry(1, 0)};
}

/// 2 mu E + lambda tr(E) I of a strain with doubled shears; the Lame constants times the volume.
template <class Real>
HWY_INLINE Symmetric<Real> hooke(Vector<Real> lambda, Vector<Real> mu, const Symmetric<Real>& E)
{
    const Vector<Real> twoMu = mu + mu, pressure = lambda * trace(E);
    return {hn::MulAdd(twoMu, E.xx, pressure),
            hn::MulAdd(twoMu, E.yy, pressure),
            hn::MulAdd(twoMu, E.zz, pressure),
            mu * E.yz,
            mu * E.xz,
            mu * E.xy};
}

/// What a vector of elements needs of its nodes.
template <class Real>
struct StagedNodes
{
    StagedEdges<double, width<Real>()> m_x;
    StagedEdges<Real> m_v;

    HWY_INLINE void stage(const ElementPass<Real>& pass, const std::int32_t (*node)[4], Range lanes)
    {
        HWY_UNROLL(4)
        for (int lane = lanes.m_begin; lane < lanes.m_end; ++lane)
        {
            const std::int32_t own[4] = {node[lane][0], node[lane][1], node[lane][2], node[lane][3]};
            m_x.stageLane(lane, own, pass.m_x);
            m_v.stageLane(lane, own, pass.m_v);
        }
    }
};

/// The elements of a block from `lane` on, as many as a vector has lanes. Strains and stresses are those of the world's
/// frame, R E R^T = sym(F R^T) - I: with F R^T = D_s g'^T, g' = R D_m^-T, forces and tension need R by g' alone.
template <class Real>
struct PassLanes
{
    const ElementPass<Real>& m_pass;
    const StagedNodes<Real>& m_nodes;
    int m_block, m_lane;

    HWY_INLINE const ElementBlock<Real>& block() const { return m_pass.m_elements->m_blocks[m_block]; }
    HWY_INLINE DeformedEdges<Real> x() const { return {m_nodes.m_x}; }
    HWY_INLINE Quaternion* rotations() const { return m_pass.m_rotation + m_block * kLanes + m_lane; }

    HWY_INLINE Matrix<Real> deformationGradient() const
    {
        return times(x().edges(), loadMatrix(block().m_DmInverse, m_lane));
    }

    /// All that follows from the rotations; between its parts, other(part) for part in [0, 3].
    template <class Other>
    HWY_INLINE void run(const Quaternions<Real>& q, const Other& other) const
    {
        const Lanes<Real> d;
        const Vector<Real> lambda = hn::Load(d, block().m_lambdaVolume + m_lane);
        const Vector<Real> mu = hn::Load(d, block().m_muVolume + m_lane);
        other(0);
        const Matrix<Real> R = toMatrix(q, number<Real>(2));
        const Matrix<Real> g = timesTranspose(R, loadMatrix(block().m_DmInverse, m_lane));  // R D_m^-T
        // D_s - R D_m instead of D_s: sym(F R^T) - I would lose strains to rounding.
        const Matrix<Real> stretch = x().minusRotated(q, block().m_Dm, m_lane);
        const Symmetric<Real> strain = strainOf(stretch, g);
        other(1);
        const Symmetric<Real> rate = strainOf(m_nodes.m_v.load(), g);
        const Symmetric<Real> damped = combined<Real>(number<Real>(m_pass.m_damping), rate, number<Real>(1), strain);
        const Symmetric<Real> minusStress = hooke<Real>(hn::Neg(lambda), hn::Neg(mu), damped);
        other(2);
        storeCorners(times(full(minusStress), g), m_pass.m_force[m_block], m_lane);
        storeWarped(g, lambda, mu);
        other(3);
        storeTension(hooke<Real>(lambda, mu, strain));
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
        const Vector<Real> zero = number<Real>(0);
        Symmetric<Real> T = {zero, zero, zero, zero, zero, zero};
        if (m_pass.m_tensionFactor != 0) T = positivePart(number<Real>(m_pass.m_tensionFactor), elastic);
        const Vector<Real> entries[6] = {T.xx, T.yy, T.zz, T.yz, T.xz, T.xy};
        HWY_UNROLL(6)
        for (int k = 0; k < 6; ++k) hn::Store(entries[k], d, m_pass.m_warped[m_block].m_tension[k] + m_lane);
    }
};

template <class Real>
HWY_INLINE void passBlocks(const ElementPass<Real>& pass, Range blocks)
{
    constexpr int kN = width<Real>(), kVectors = kLanes / kN;  // of a block
    StagedNodes<Real> staged[2][kBatch];
    Matrix<Real> F[kBatch];
    Quaternions<Real> q[kBatch];
    const int begin = blocks.m_begin * kVectors, end = blocks.m_end * kVectors;
    const auto nodes = [&](int k) { return pass.m_elements->m_blocks[k / kVectors].m_node + k % kVectors * kN; };

    for (int k = begin; k < HWY_MIN(begin + kBatch, end); ++k) staged[0][k - begin].stage(pass, nodes(k), {0, kN});
    for (int k = begin, turn = 0; k < end; k += kBatch, turn = 1 - turn)
    {
        const int count = HWY_MIN(kBatch, end - k);
        const auto lanes = [&](int i) {
            return PassLanes<Real>{pass, staged[turn][i], (k + i) / kVectors, (k + i) % kVectors * kN};
        };
        for (int i = 0; i < count; ++i)
        {
            F[i] = lanes(i).deformationGradient();
            q[i] = loadQuaternions(lanes(i).rotations(), Real());
        }
        polarRotations(F, count, q);
        for (int i = 0; i < count; ++i)
        {
            storeQuaternions(q[i], lanes(i).rotations());
            // The processor loads for the next batch while it computes; beyond the end, once more for the last vector.
            const auto next = nodes(HWY_MIN(k + kBatch + i, end - 1));
            const auto stageNext = [&](int part) {
                staged[1 - turn][i].stage(pass, next, {part * kN / 4, (part + 1) * kN / 4});
            };
            lanes(i).run(q[i], stageNext);
        }
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
