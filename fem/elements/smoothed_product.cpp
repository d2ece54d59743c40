// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/common/vector_targets.h"
#include "fem/elements/smoothed_elements.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/smoothed_product.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/smoothed_strain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// For processors without vector instructions.
template <class Real>
void productStrains(const SmoothedProduct<Real>& product, Range pieces)
{
    reference::findStrains(product, pieces);
}

template <class Real>
void productForces(const SmoothedProduct<Real>& product, Range blocks)
{
    reference::findForces(product, blocks);
}

#else

template <class Real>
HWY_INLINE Symmetric<Real> loadSymmetric(const Real (*entries)[kLanes], int lane)
{
    const Lanes<Real> d;
    return {hn::Load(d, entries[0] + lane), hn::Load(d, entries[1] + lane), hn::Load(d, entries[2] + lane),
            hn::Load(d, entries[3] + lane), hn::Load(d, entries[4] + lane), hn::Load(d, entries[5] + lane)};
}

template <class Real>
void productStrains(const SmoothedProduct<Real>& product, Range pieces)
{
    const Lanes<Real> d;
    const ElementBlocks<Real>& elements = *product.m_elements.m_elements;
    StagedEdges<Real> edges[2][ElementPatches::kMax];
    Symmetric<Real> strain[ElementPatches::kMax];
    const auto stage = [&](const PatchColumn& column, int k, int slot)
    { edges[slot][k].stage(elements.m_blocks[column.m_block + k].m_node + column.m_lane, product.m_elements.m_p); };
    const auto compute = [&](const PatchColumn& column, int slot, const auto& other)
    {
        const int lane = column.m_lane;
        Vector<Real> theta = hn::Zero(d);
        for (int k = 0; k < column.m_size; ++k)
        {
            other(k);
            const int b = column.m_block + k;
            const SmoothedBlock<Real>& warped = product.m_warped[b];
            const Matrix<Real> H = times(edges[slot][k].load(), loadMatrix(elements.m_blocks[b].m_DmInverse, lane));
            strain[k] = strainInFrameOf(loadMatrix(warped.m_rotation, lane), H);
            const Matrix<Real> T = full(loadSymmetric(warped.m_tension, lane));
            storeMatrix(times(H, T), product.m_tension[b].m_entry, lane);
            theta = hn::MulAdd(hn::Load(d, elements.m_share[b].m_lane + lane), trace(strain[k]), theta);
        }
        for (int k = 0; k < column.m_size; ++k)
            storeQuads<Real>(strain[k], theta, product.m_strain.m_element[column.m_block + k], lane);
    };
    forEachColumn<Real>(elements.m_groups, pieces, stage, compute);
}

template <class Real>
void productForces(const SmoothedProduct<Real>& product, Range blocks)
{
    const Vector<Real> factor = number<Real>(product.m_elements.m_stiffnessFactor);
    const ElementBlocks<Real>& elements = *product.m_elements.m_elements;
    StagedStrains<Real> smoothed[2];
    const auto stage = [&](int b, int lane, int slot)
    { smoothed[slot].stage(*product.m_smoothing, product.m_strain, b, lane); };
    const auto compute = [&](int b, int lane, int slot)
    {
        Vector<Real> theta;
        const auto& own = product.m_strain.m_element[b].m_quad;
        loadQuads<Real>(own[0][lane], own[1][lane], theta);
        const Vector<Real> lambda = factor * loadLambda(elements, b, lane), mu = factor * loadMu(elements, b, lane);
        const Symmetric<Real> stress = smoothedStress<Real>(lambda, mu, smoothed[slot].load(), theta);
        Matrix<Real> P = times(loadMatrix(product.m_warped[b].m_rotation, lane), full(stress));
        const Matrix<Real> tension = loadMatrix(product.m_tension[b].m_entry, lane);
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) P.m[k / 3][k % 3] = P.m[k / 3][k % 3] + tension.m[k / 3][k % 3];
        storeCorners(timesTranspose(P, loadMatrix(elements.m_blocks[b].m_DmInverse, lane)), product.m_elements.m_out[b],
                     lane);
    };
    forEachVector<Real>(blocks, stage, compute);
}

#endif

void smoothedProductStrainsFloat(const SmoothedProduct<float>& product, Range pieces)
{
    productStrains(product, pieces);
}

void smoothedProductStrainsDouble(const SmoothedProduct<double>& product, Range pieces)
{
    productStrains(product, pieces);
}

void smoothedProductForcesFloat(const SmoothedProduct<float>& product, Range blocks)
{
    productForces(product, blocks);
}

void smoothedProductForcesDouble(const SmoothedProduct<double>& product, Range blocks)
{
    productForces(product, blocks);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(smoothedProductStrainsFloat);
HWY_EXPORT(smoothedProductStrainsDouble);
HWY_EXPORT(smoothedProductForcesFloat);
HWY_EXPORT(smoothedProductForcesDouble);

template <>
void findStrains(const SmoothedProduct<float>& product, Range pieces)
{
    HWY_DYNAMIC_DISPATCH(smoothedProductStrainsFloat)(product, pieces);
}

template <>
void findStrains(const SmoothedProduct<double>& product, Range pieces)
{
    HWY_DYNAMIC_DISPATCH(smoothedProductStrainsDouble)(product, pieces);
}

template <>
void findForces(const SmoothedProduct<float>& product, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(smoothedProductForcesFloat)(product, blocks);
}

template <>
void findForces(const SmoothedProduct<double>& product, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(smoothedProductForcesDouble)(product, blocks);
}

}  // namespace bullet_fem
#endif
