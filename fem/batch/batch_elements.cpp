// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/batch/batch_elements.h"

#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/batch/batch_elements.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "fem/batch/batch_exchange-inl.h"
#include "fem/batch/lane_element-inl.h"
#include "fem/elements/assumed_strain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// For processors without vector instructions: empty.
void passLanes(const BatchElements&, const BatchElementPass&) {}
void multiply(const BatchElements&, double, const double*) {}

#else

constexpr int kVectors = kBatchWidth / width<float>();  // vectors per element

/// The elements of a block, with access to the bodies' arrays.
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

// Each stage of the work is a separate loop over a block: a fused loop would spill registers, and its cache misses
// would be too far apart for out-of-order execution.

// Prefetches the output.
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

HWY_NOINLINE void gatherRotations(const LaneBlock& block)
{
    const float* before[kBatchWidth];
    for (int b = 0; b < kBatchWidth; ++b) before[b] = &block.m_pass.m_rotationBefore[b][block.m_first].x;
    for (int e = 0; e < block.m_count; ++e)  // one exchange block holds a quaternion
        gatherBlocks(before, 4 * e, block.element(e * kVectors).rotations(), kBatchWidth);
}

HWY_NOINLINE void rotate(const LaneBlock& block)
{
    gatherRotations(block);
    for (int k = 0; k < block.vectors(); ++k)
    {
        const LaneElement element = block.element(k);
        const Matrix<float> A = times(roundedEdges<float>(element), element.DmInverse());
        Quaternions<float> q = element.loadRotations();
        polarRotations(&A, 1, &q);
        element.storeRotations(q);
    }
}

// Adds the elastic forces, and stores elastic stresses in place of tensions.
HWY_NOINLINE void addForces(const LaneBlock& block)
{
    for (int k = 0; k < block.vectors(); ++k)
    {
        const LaneElement element = block.element(k);
        element.storeTension(passElements(element, element.loadRotations(), [](int) {}));
    }
}

// Visits the elements of a patch group column by column: the order in which a single body's nodes sum them.
template <class Visit>
HWY_INLINE void forEachPatch(const BatchElements& all, const PatchGroup& group, const Visit& visit)
{
    for (int column = 0; column < kLanes; ++column)
    {
        const int first = group.m_firstBlock * kLanes + column;
        if (!all.m_lanes->isCopy(first)) visit(first);
    }
}

// Adds the elastic forces of patches, and stores elastic stresses in place of tensions.
HWY_NOINLINE void addPatchForces(const BatchElements& all, const BatchElementPass& pass, int index)
{
    const PatchGroup& group = all.m_rest->m_groups[index];
    PatchStrains<float> patch;
    forEachPatch(all, group,
                 [&](int first)
                 {
                     for (int body = 0; body < kBatchWidth; body += width<float>())
                     {
                         for (int k = 0; k < group.m_blocks; ++k)
                         {
                             const LaneElement element = {all, &pass, first + k * kLanes, body};
                             patch.add(k, element, element.loadRotations());
                         }
                         for (int k = 0; k < group.m_blocks; ++k)
                         {
                             const int e = first + k * kLanes;
                             const LaneElement element = {all, &pass, e, body, all.m_lanes->isCopy(e), index};
                             element.storeTension(patch.finish(k, element));
                         }
                     }
                 });
}

// As addPatchForces(), with assumed strains; turns the frames of the patches.
HWY_NOINLINE void addAssumedForces(const BatchElements& all, const BatchElementPass& pass, int index)
{
    const int count = all.m_rest->m_groups[index].m_blocks;
    PatchAssumed<float> patch;
    forEachPatch(all, all.m_rest->m_groups[index],
                 [&](int first)
                 {
                     for (int body = 0; body < kBatchWidth; body += width<float>())
                     {
                         const auto element = [&](int k)
                         {
                             const int e = first + k * kLanes;
                             return LaneElement{all, &pass, e, body, all.m_lanes->isCopy(e), index};
                         };
                         for (int k = 0; k < count; ++k) patch.addGradient(k, element(k));
                         Quaternions<float> q = element(0).loadRotations();
                         polarRotations(&patch.m_gradient.m_mean, 1, &q);
                         patch.setFrame(q);
                         for (int k = 0; k < count; ++k)
                         {
                             element(k).storeRotations(q);
                             patch.add(k, element(k));
                         }
                         for (int k = 0; k < count; ++k) patch.respond(k, element(k));
                         for (int k = 0; k < count; ++k) element(k).storeTension(patch.finish(k, element(k)));
                     }
                 });
}

// Two halves of tensionOf(), because square roots and divisions have long latencies and need several independent lanes.
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
        for (int e = 0; e < block.m_count; e += kSome)  // the last exchange includes the block's padding
            scatterBlocks(warped, row * kLanes + e, block.element(e * kVectors).gradients() + row * kBatchWidth,
                          kStride);
}

HWY_INLINE void finishBlock(const LaneBlock& block)
{
    if (block.m_pass.m_tensionFactor == 0)
        clearTensions(block);
    else
        makeTensions(block);
    tellBodies(block);
}

HWY_INLINE void passPatches(const BatchElements& all, const BatchElementPass& pass)
{
    const bool isAssumed = !all.m_rest->m_filter.empty();
    for (int index = 0; index < static_cast<int>(all.m_rest->m_groups.size()); ++index)
    {
        const PatchGroup& group = all.m_rest->m_groups[index];
        const auto block = [&](int k) { return LaneBlock{all, pass, (group.m_firstBlock + k) * kLanes, kLanes}; };
        for (int k = 0; k < group.m_blocks; ++k)
        {
            prefetchBodies(block(k));
            if (isAssumed)
                gatherRotations(block(k));
            else
                rotate(block(k));
        }
        if (isAssumed)
            addAssumedForces(all, pass, index);
        else
            addPatchForces(all, pass, index);
        for (int k = 0; k < group.m_blocks; ++k) finishBlock(block(k));
    }
}

HWY_INLINE void passLanes(const BatchElements& all, const BatchElementPass& pass)
{
    if (all.m_rest->hasPatches()) return passPatches(all, pass);
    for (int first = 0; first < all.m_count; first += kLanes)
    {
        const LaneBlock block = {all, pass, first, HWY_MIN(kLanes, all.m_count - first)};
        prefetchBodies(block);
        rotate(block);
        addForces(block);
        finishBlock(block);
    }
}

HWY_INLINE void multiplyPatches(const BatchElements& all, double stiffnessFactor, const double* p)
{
    const F factor = number<float>(stiffnessFactor);
    Matrix<float> H[ElementPatches::kMax];
    for (const PatchGroup& group : all.m_rest->m_groups)
        forEachPatch(all, group,
                     [&](int first)
                     {
                         for (int body = 0; body < kBatchWidth; body += width<float>())
                         {
                             F dilatation = hn::Zero(Lanes<float>());
                             for (int k = 0; k < group.m_blocks; ++k)
                             {
                                 const LaneElement element = {all, nullptr, first + k * kLanes, body};
                                 H[k] = times(element.roundedEdgesOf(p), element.loadGradients());
                                 dilatation = hn::MulAdd(element.share(), trace(H[k]), dilatation);
                             }
                             for (int k = 0; k < group.m_blocks; ++k)
                             {
                                 const LaneElement element = {all, nullptr, first + k * kLanes, body};
                                 if (all.m_lanes->isCopy(element.m_element)) continue;
                                 const F lambda = factor * element.lambda(), mu = factor * element.mu();
                                 const F pressure = pressureInPatch<float>(lambda, mu, trace(H[k]), dilatation);
                                 const Matrix<float> P = warpedStress<float>(pressure, mu, element.loadTension(), H[k]);
                                 element.storeForces(timesTranspose(P, element.loadGradients()));
                             }
                         }
                     });
}

HWY_INLINE void multiplyAssumed(const BatchElements& all, double stiffnessFactor, const double* p)
{
    const F factor = number<float>(stiffnessFactor);
    PatchAssumedProduct<float> patch;
    for (int index = 0; index < static_cast<int>(all.m_rest->m_groups.size()); ++index)
    {
        const PatchGroup& group = all.m_rest->m_groups[index];
        forEachPatch(all, group,
                     [&](int first)
                     {
                         for (int body = 0; body < kBatchWidth; body += width<float>())
                         {
                             const auto lanes = [&](int k)
                             { return LaneElement{all, nullptr, first + k * kLanes, body, false, index}; };
                             for (int k = 0; k < group.m_blocks; ++k)
                                 patch.add(k, lanes(k), lanes(k).roundedEdgesOf(p));
                             for (int k = 0; k < group.m_blocks; ++k)
                                 if (!all.m_lanes->isCopy(first + k * kLanes))
                                     lanes(k).storeForces(patch.forces(k, lanes(k), factor));
                         }
                     });
    }
}

HWY_INLINE void multiply(const BatchElements& all, double stiffnessFactor, const double* p)
{
    if (!all.m_rest->m_filter.empty()) return multiplyAssumed(all, stiffnessFactor, p);
    if (all.m_rest->hasPatches()) return multiplyPatches(all, stiffnessFactor, p);
    const F factor = number<float>(stiffnessFactor);
    for (int e = 0; e < all.m_count; ++e)
        for (int lane = 0; lane < kBatchWidth; lane += width<float>())
        {
            const LaneElement element = {all, nullptr, e, lane};
            const Matrix<float> g = element.loadGradients();
            const Matrix<float> H = times(element.roundedEdgesOf(p), g);
            const Matrix<float> P = warpedStress<float>(factor * element.lambda() * trace(H), factor * element.mu(),
                                                        element.loadTension(), H);
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

bool hasBatchKernels()
{
    return HWY_DYNAMIC_DISPATCH(HasLaneKernels)();
}

BULLETFEM_EXPORT(PassOverLanes, void runElementPass(const BatchElements& elements, const BatchElementPass& pass),
                 elements, pass)
BULLETFEM_EXPORT(MultiplyLanes,
                 void runElementProduct(const BatchElements& elements, double stiffnessFactor, const double* p),
                 elements, stiffnessFactor, p)

}  // namespace bullet_fem
#endif
