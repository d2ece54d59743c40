// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/element_product.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/element_product.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/assumed_strain-inl.h"
#include "fem/elements/response_elements-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

template <class Real>
HWY_INLINE void multiplyBlocks(const ElementProduct<Real>& product, Range blocks)
{
    const Lanes<Real> d;
    const Vector<Real> factor = number<Real>(product.m_stiffnessFactor);
    StagedEdges<Real> edges[2];
    const auto stage = [&](int b, int lane, int slot)
    { edges[slot].stage(product.m_elements->m_blocks[b].m_node + lane, product.m_p); };
    const auto compute = [&](int b, int lane, int slot)
    {
        const WarpedBlock<Real>& element = product.m_warped[b];
        const Matrix<Real> g = loadMatrix(element.m_gradient, lane);  // row a is g'_a
        const Matrix<Real> H = times(edges[slot].load(), g);
        const Vector<Real> lambda = hn::Load(d, product.m_elements->m_blocks[b].m_lambdaVolume + lane);
        const Vector<Real> mu = hn::Load(d, product.m_elements->m_blocks[b].m_muVolume + lane);
        if (product.m_tangent)
        {
            const Matrix<Real> P = tangentTimes<Real>(product.m_tangent[b], loadSymmetric(element.m_tension, lane),
                                                      lane, factor, mu, hn::Zero(d), H);
            storeCorners(timesTranspose(P, g), product.m_out[b], lane);
            return;
        }
        const Matrix<Real> P =
            warpedStress<Real>(factor * lambda * trace(H), factor * mu, loadSymmetric(element.m_tension, lane), H);
        storeCorners(timesTranspose(P, g), product.m_out[b], lane);
    };
    forEachVector<Real>(blocks, stage, compute);
}

template <class Real>
HWY_INLINE void multiplyPatches(const ElementProduct<Real>& product, Range groups)
{
    const Lanes<Real> d;
    const Vector<Real> factor = number<Real>(product.m_stiffnessFactor);
    const ElementBlocks<Real>& elements = *product.m_elements;
    StagedEdges<Real> edges[2][ElementPatches::kMax];
    Matrix<Real> H[ElementPatches::kMax];
    const auto stage = [&](const PatchColumn& column, int k, int slot)
    { edges[slot][k].stage(elements.m_blocks[column.m_block + k].m_node + column.m_lane, product.m_p); };
    const auto compute = [&](const PatchColumn& column, int slot, const auto& other)
    {
        Vector<Real> dilatation = hn::Zero(d);
        for (int k = 0; k < column.m_size; ++k)
        {
            const int b = column.m_block + k;
            H[k] = times(edges[slot][k].load(), loadMatrix(product.m_warped[b].m_gradient, column.m_lane));
            const Vector<Real> share = hn::Load(d, elements.m_share[b].m_lane + column.m_lane);
            dilatation = hn::MulAdd(share, trace(H[k]), dilatation);
        }
        for (int k = 0; k < column.m_size; ++k)
        {
            other(k);
            const int b = column.m_block + k, lane = column.m_lane;
            const WarpedBlock<Real>& element = product.m_warped[b];
            const Vector<Real> lambda = factor * hn::Load(d, elements.m_blocks[b].m_lambdaVolume + lane);
            const Vector<Real> mu = factor * hn::Load(d, elements.m_blocks[b].m_muVolume + lane);
            const Vector<Real> pressure = pressureInPatch<Real>(lambda, mu, trace(H[k]), dilatation);
            const Matrix<Real> P = warpedStress<Real>(pressure, mu, loadSymmetric(element.m_tension, lane), H[k]);
            storeCorners(timesTranspose(P, loadMatrix(element.m_gradient, lane)), product.m_out[b], lane);
        }
    };
    forEachColumn<Real>(elements.m_groups, groups, stage, compute);
}

template <class Real>
HWY_INLINE void multiplyResponsePatches(const ElementProduct<Real>& product, Range groups)
{
    const Lanes<Real> d;
    const Vector<Real> factor = number<Real>(product.m_stiffnessFactor);
    const ElementBlocks<Real>& elements = *product.m_elements;
    StagedEdges<Real> edges[2][ElementPatches::kMax];
    Matrix<Real> H[ElementPatches::kMax];
    const auto stage = [&](const PatchColumn& column, int k, int slot)
    { edges[slot][k].stage(elements.m_blocks[column.m_block + k].m_node + column.m_lane, product.m_p); };
    const auto compute = [&](const PatchColumn& column, int slot, const auto& other)
    {
        const int lane = column.m_lane;
        Vector<Real> mean = hn::Zero(d);
        for (int k = 0; k < column.m_size; ++k)
        {
            const int b = column.m_block + k;
            H[k] = times(edges[slot][k].load(), loadMatrix(product.m_warped[b].m_gradient, lane));
            const Symmetric<Real> C = loadSymmetric(product.m_tangent[b].m_cofactor, lane);
            mean = hn::MulAdd(hn::Load(d, elements.m_share[b].m_lane + lane), contraction(C, H[k]), mean);
        }
        for (int k = 0; k < column.m_size; ++k)
        {
            other(k);
            const int b = column.m_block + k;
            const WarpedBlock<Real>& element = product.m_warped[b];
            const Vector<Real> mu = hn::Load(d, elements.m_blocks[b].m_muVolume + lane);
            const Matrix<Real> P = tangentTimes<Real>(product.m_tangent[b], loadSymmetric(element.m_tension, lane),
                                                      lane, factor, mu, mean, H[k]);
            storeCorners(timesTranspose(P, loadMatrix(element.m_gradient, lane)), product.m_out[b], lane);
        }
    };
    forEachColumn<Real>(elements.m_groups, groups, stage, compute);
}

/// The elements of a column, from `m_lane` on of block m_block.
template <class Real>
struct ProductLanes
{
    const ElementProduct<Real>& m_product;
    int m_block, m_lane, m_group;

    HWY_INLINE const ElementBlock<Real>& block() const { return m_product.m_elements->m_blocks[m_block]; }
    HWY_INLINE Vector<Real> share() const
    {
        return hn::Load(Lanes<Real>(), m_product.m_elements->m_share[m_block].m_lane + m_lane);
    }
    HWY_INLINE Vector<Real> lambda() const { return hn::Load(Lanes<Real>(), block().m_lambdaVolume + m_lane); }
    HWY_INLINE Vector<Real> mu() const { return hn::Load(Lanes<Real>(), block().m_muVolume + m_lane); }
    HWY_INLINE Matrix<Real> DmInverse() const { return loadMatrix(block().m_DmInverse, m_lane); }
    HWY_INLINE Vector<Real> filter(int entry) const
    {
        return hn::Load(Lanes<Real>(), m_product.m_elements->m_filter[m_group].m_entry[entry] + m_lane);
    }
    HWY_INLINE Matrix<Real> loadRotation() const { return loadMatrix(m_product.m_warped[m_block].m_gradient, m_lane); }
    HWY_INLINE Symmetric<Real> loadTension() const
    {
        return loadSymmetric(m_product.m_warped[m_block].m_tension, m_lane);
    }
};

template <class Real>
HWY_INLINE void multiplyAssumed(const ElementProduct<Real>& product, Range groups)
{
    const Vector<Real> factor = number<Real>(product.m_stiffnessFactor);
    const ElementBlocks<Real>& elements = *product.m_elements;
    StagedEdges<Real> edges[2][ElementPatches::kMax];
    PatchAssumedProduct<Real> patch;
    const auto stage = [&](const PatchColumn& column, int k, int slot)
    { edges[slot][k].stage(elements.m_blocks[column.m_block + k].m_node + column.m_lane, product.m_p); };
    const auto compute = [&](const PatchColumn& column, int slot, const auto& other)
    {
        const auto lanes = [&](int k) {
            return ProductLanes<Real>{product, column.m_block + k, column.m_lane, column.m_group};
        };
        for (int k = 0; k < column.m_size; ++k) patch.add(k, lanes(k), edges[slot][k].load());
        for (int k = 0; k < column.m_size; ++k)
        {
            other(k);
            storeCorners(patch.forces(k, lanes(k), factor), product.m_out[column.m_block + k], column.m_lane);
        }
    };
    forEachColumn<Real>(elements.m_groups, groups, stage, compute);
}

template <class Real>
void multiplyUnits(const ElementProduct<Real>& product, Range pieces)
{
    if (!product.m_elements->hasPatches()) return multiplyBlocks(product, pieces);
    if (product.m_tangent) return multiplyResponsePatches(product, pieces);
    if (!product.m_elements->m_filter.empty()) return multiplyAssumed(product, pieces);
    multiplyPatches(product, pieces);
}

BULLETFEM_KERNEL(multiplyUnits, ElementProduct)

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT_KERNEL(multiplyUnits, ElementProduct, runElementProduct)

}  // namespace bullet_fem
#endif
