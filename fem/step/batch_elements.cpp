// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/step/batch_elements.h"

#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/step/batch_elements.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "fem/elements/element_math-inl.h"
#include "fem/step/batch_exchange-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// Processors with nothing that Highway knows.
void passLanes(const BatchElements&, const BatchElementPass&) {}
void multiply(const BatchElements&, double, const double*) {}

#else

using F = Vector<float>;

HWY_INLINE Vector<double> difference(const double* to, const double* from)
{
    const Lanes<double> d;
    return hn::Sub(hn::Load(d, to), hn::Load(d, from));
}

/// One element of as many bodies as a vector has lanes.
struct LaneElement
{
    const BatchElements& m_all;
    const BatchElementPass* m_pass;
    int m_element, m_lane;  // the first body

    HWY_INLINE const ElementBlock<float>& block() const { return m_all.m_rest->m_blocks[m_element / kLanes]; }
    HWY_INLINE int place() const { return m_element % kLanes; }
    HWY_INLINE const BatchCorners& corners() const { return m_all.m_corners[m_element]; }
    HWY_INLINE double* sumOf(int corner) const { return m_all.m_sums + corners().m_sum[corner] + m_lane; }
    HWY_INLINE float* rotations() const
    {
        return m_all.m_rotation + static_cast<std::size_t>(m_element) * 4 * kBatchWidth + m_lane;
    }
    HWY_INLINE float* gradients() const
    {
        return m_all.m_warped + static_cast<std::size_t>(m_element) * kWarpedRows * kBatchWidth + m_lane;
    }
    HWY_INLINE float* tensions() const { return gradients() + 9 * kBatchWidth; }

    HWY_INLINE F lambda() const { return hn::Set(Lanes<float>(), block().m_lambdaVolume[place()]); }
    HWY_INLINE F mu() const { return hn::Set(Lanes<float>(), block().m_muVolume[place()]); }
    HWY_INLINE F damping() const { return number<float>(m_pass->m_damping); }
    HWY_INLINE Matrix<float> DmInverse() const
    {
        Matrix<float> A;
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) A.m[k / 3][k % 3] = hn::Set(Lanes<float>(), block().m_DmInverse[k][place()]);
        return A;
    }
    HWY_INLINE Matrix<double> restEdges(int) const
    {
        Matrix<double> A;
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) A.m[k / 3][k % 3] = hn::Set(Lanes<double>(), block().m_Dm[k][place()]);
        return A;
    }
    HWY_INLINE Matrix<double> edgesOf(const double* values, int part) const
    {
        const double* at = values + m_lane + part * width<double>();
        const double* from = at + corners().m_node[0];
        Matrix<double> D;
        HWY_UNROLL(3)
        for (int a = 0; a < 3; ++a)
        {
            const double* to = at + corners().m_node[a + 1];
            HWY_UNROLL(3)
            for (int i = 0; i < 3; ++i) D.m[i][a] = difference(to + i * kBatchWidth, from + i * kBatchWidth);
        }
        return D;
    }
    HWY_INLINE Matrix<double> edges(int part) const { return edgesOf(m_pass->m_x, part); }
    HWY_INLINE Matrix<float> roundedEdgesOf(const double* values) const
    {
        Matrix<double> D[parts<float>()];
        HWY_UNROLL(2)
        for (int part = 0; part < parts<float>(); ++part) D[part] = edgesOf(values, part);
        return roundedMatrix<float>(D);
    }
    HWY_INLINE Matrix<float> velocityEdges() const { return roundedEdgesOf(m_pass->m_v); }

    /// Adds f_1, f_2, f_3, the columns given, and f_0 = -(f_1 + f_2 + f_3) to the sums of the corners.
    HWY_INLINE void storeForces(const Matrix<float>& f) const
    {
        double* const sums[4] = {sumOf(0), sumOf(1), sumOf(2), sumOf(3)};
        HWY_UNROLL(3)
        for (int i = 0; i < 3; ++i)
        {
            const F others = hn::Add(hn::Add(f.m[i][0], f.m[i][1]), f.m[i][2]);
            addTo(sums[0] + i * kBatchWidth, hn::Sub(hn::Zero(Lanes<float>()), others));
            HWY_UNROLL(3)
            for (int a = 0; a < 3; ++a) addTo(sums[a + 1] + i * kBatchWidth, f.m[i][a]);
        }
    }
    static HWY_INLINE void addTo(double* sum, F value)
    {
        const Lanes<double> d;
        HWY_UNROLL(2)
        for (int part = 0; part < parts<float>(); ++part, sum += width<double>())
            hn::Store(hn::Add(hn::Load(d, sum), promoted(value, part)), d, sum);
    }
    HWY_INLINE void storeGradients(const Matrix<float>& g) const
    {
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) hn::Store(g.m[k % 3][k / 3], Lanes<float>(), gradients() + k * kBatchWidth);
    }
    HWY_INLINE Matrix<float> loadGradients() const
    {
        Matrix<float> g;
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) g.m[k / 3][k % 3] = hn::Load(Lanes<float>(), gradients() + k * kBatchWidth);
        return g;
    }
    HWY_INLINE void storeTension(const Symmetric<float>& T) const
    {
        const F entries[6] = {T.xx, T.yy, T.zz, T.yz, T.xz, T.xy};
        HWY_UNROLL(6)
        for (int k = 0; k < 6; ++k) hn::Store(entries[k], Lanes<float>(), tensions() + k * kBatchWidth);
    }
    HWY_INLINE Symmetric<float> loadTension() const
    {
        const Lanes<float> d;
        const float* t = tensions();
        return {hn::Load(d, t),
                hn::Load(d, t + kBatchWidth),
                hn::Load(d, t + 2 * kBatchWidth),
                hn::Load(d, t + 3 * kBatchWidth),
                hn::Load(d, t + 4 * kBatchWidth),
                hn::Load(d, t + 5 * kBatchWidth)};
    }

    HWY_INLINE Quaternions<float> loadRotations() const
    {
        const Lanes<float> d;
        const float* q = rotations();
        return {hn::Load(d, q), hn::Load(d, q + kBatchWidth), hn::Load(d, q + 2 * kBatchWidth),
                hn::Load(d, q + 3 * kBatchWidth)};
    }
    HWY_INLINE void storeRotations(const Quaternions<float>& q) const
    {
        const Lanes<float> d;
        float* to = rotations();
        hn::Store(q.x, d, to);
        hn::Store(q.y, d, to + kBatchWidth);
        hn::Store(q.z, d, to + 2 * kBatchWidth);
        hn::Store(q.w, d, to + 3 * kBatchWidth);
    }
};

constexpr int kVectors = kBatchWidth / width<float>();  // of an element

/// Elements of a block, and the bodies' arrays of theirs.
struct LaneBlock
{
    const BatchElements& m_all;
    const BatchElementPass& m_pass;
    int m_first, m_count;

    HWY_INLINE int vectors() const { return m_count * kVectors; }
    HWY_INLINE LaneElement element(int vector) const
    {
        return {m_all, &m_pass, m_first + vector / kVectors, vector % kVectors * width<float>()};
    }
};

// Each kind of work is a loop of its own over a block: larger loops leave no registers, and what they wait for is too
// far away for the processor to see it.

// What is written in the end is asked for while there is much to compute.
HWY_NOINLINE void prefetchBodies(const LaneBlock& block)
{
    constexpr int kLine = 64 / sizeof(float);
    for (WarpedBlock<float>* warped : block.m_pass.m_warped)
    {
        if (!warped) continue;
        const float* rows = warped[block.m_first / kLanes].rows();
        for (int k = 0; k < kWarpedRows * kLanes; k += kLine) hwy::Prefetch(rows + k);
    }
}

HWY_NOINLINE void rotate(const LaneBlock& block)
{
    const float* before[kBatchWidth];
    for (int b = 0; b < kBatchWidth; ++b) before[b] = &block.m_pass.m_rotationBefore[b][block.m_first].x;
    for (int e = 0; e < block.m_count; ++e)  // a quaternion is a block of exchanges
        gatherBlocks(before, 4 * e, block.element(e * kVectors).rotations(), kBatchWidth);
    for (int k = 0; k < block.vectors(); ++k)
    {
        const LaneElement element = block.element(k);
        const Matrix<float> A = times(roundedEdges<float>(element), element.DmInverse());
        Quaternions<float> q = element.loadRotations();
        polarRotations(&A, 1, &q);
        element.storeRotations(q);
    }
}

// Leaves elastic stresses where tensions are to be.
HWY_NOINLINE void addForces(const LaneBlock& block)
{
    for (int k = 0; k < block.vectors(); ++k)
    {
        const LaneElement element = block.element(k);
        element.storeTension(passElements(element, element.loadRotations(), [](int) {}));
    }
}

// Half of tensionOf() at a time: so much of it waits for roots and quotients that the processor needs several at once.
HWY_NOINLINE void makeTensions(const LaneBlock& block)
{
    FarEigenvalue<float> far[kLanes * kVectors];
    for (int k = 0; k < block.vectors(); ++k) far[k] = farEigenvalue(block.element(k).loadTension());
    const F factor = number<float>(block.m_pass.m_tensionFactor);
    for (int k = 0; k < block.vectors(); ++k)
    {
        const LaneElement element = block.element(k);
        element.storeTension(positivePart(factor, element.loadTension(), far[k]));
    }
}

HWY_NOINLINE void clearTensions(const LaneBlock& block)
{
    for (int k = 0; k < block.vectors(); ++k) block.element(k).storeTension(tensionOf(0, Symmetric<float>()));
}

HWY_NOINLINE void tellBodies(const LaneBlock& block)
{
    float *rotation[kBatchWidth], *warped[kBatchWidth];
    bool anyWarped = false;
    for (int b = 0; b < kBatchWidth; ++b)
    {
        Quaternion* q = block.m_pass.m_rotation[b];
        WarpedBlock<float>* w = block.m_pass.m_warped[b];
        rotation[b] = q ? &q[block.m_first].x : nullptr;
        warped[b] = w ? w[block.m_first / kLanes].rows() : nullptr;
        anyWarped = anyWarped || w;
    }
    constexpr int kSome = kBlock<float>, kStride = kWarpedRows * kBatchWidth;
    for (int e = 0; e < block.m_count; ++e)
        scatterBlocks(rotation, 4 * e, block.element(e * kVectors).rotations(), kBatchWidth);
    for (int row = 0; row < kWarpedRows && anyWarped; ++row)
        for (int e = 0; e < block.m_count; e += kSome)  // the last ones take what fills the block along
            scatterBlocks(warped, row * kLanes + e, block.element(e * kVectors).gradients() + row * kBatchWidth,
                          kStride);
}

HWY_INLINE void passLanes(const BatchElements& all, const BatchElementPass& pass)
{
    for (int first = 0; first < all.m_count; first += kLanes)
    {
        const LaneBlock block = {all, pass, first, HWY_MIN(kLanes, all.m_count - first)};
        prefetchBodies(block);
        rotate(block);
        addForces(block);
        if (pass.m_tensionFactor == 0)
            clearTensions(block);
        else
            makeTensions(block);
        tellBodies(block);
    }
}

HWY_INLINE void multiply(const BatchElements& all, double stiffnessFactor, const double* p)
{
    const F factor = number<float>(stiffnessFactor);
    for (int e = 0; e < all.m_count; ++e)
        for (int lane = 0; lane < kBatchWidth; lane += width<float>())
        {
            const LaneElement element = {all, nullptr, e, lane};
            const Matrix<float> g = element.loadGradients();
            const Matrix<float> H = times(element.roundedEdgesOf(p), g);
            const Matrix<float> P =
                warpedStress<float>(factor * element.lambda(), factor * element.mu(), element.loadTension(), H);
            element.storeForces(timesTranspose(P, g));
        }
}

#endif

bool HasLaneKernels()
{
    return HWY_TARGET != HWY_SCALAR;
}

void PassOverLanes(const BatchElements& elements, const BatchElementPass& pass)
{
    passLanes(elements, pass);
}

void MultiplyLanes(const BatchElements& elements, double stiffnessFactor, const double* p)
{
    multiply(elements, stiffnessFactor, p);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(HasLaneKernels);
HWY_EXPORT(PassOverLanes);
HWY_EXPORT(MultiplyLanes);

bool hasBatchKernels()
{
    return HWY_DYNAMIC_DISPATCH(HasLaneKernels)();
}

void runElementPass(const BatchElements& elements, const BatchElementPass& pass)
{
    HWY_DYNAMIC_DISPATCH(PassOverLanes)(elements, pass);
}

void runElementProduct(const BatchElements& elements, double stiffnessFactor, const double* p)
{
    HWY_DYNAMIC_DISPATCH(MultiplyLanes)(elements, stiffnessFactor, p);
}

}  // namespace bullet_fem
#endif
