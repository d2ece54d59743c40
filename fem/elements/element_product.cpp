// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/elements/element_product.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/element_product.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/element_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// Processors with nothing that Highway knows.
template <class Real>
void multiplyBlocks(const ElementProduct<Real>& product, Range blocks)
{
    reference::runElementProduct(product, blocks);
}

#else

template <class Real>
HWY_INLINE Symmetric<Real> loadTension(const WarpedBlock<Real>& element, int lane)
{
    const Lanes<Real> d;
    const auto& t = element.m_tension;
    return {hn::Load(d, t[0] + lane), hn::Load(d, t[1] + lane), hn::Load(d, t[2] + lane),
            hn::Load(d, t[3] + lane), hn::Load(d, t[4] + lane), hn::Load(d, t[5] + lane)};
}

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
        const Matrix<Real> P = warpedStress<Real>(factor * lambda, factor * mu, loadTension(element, lane), H);
        storeCorners(timesTranspose(P, g), product.m_out[b], lane);
    };
    forEachVector<Real>(blocks, stage, compute);
}

#endif

void elementProductFloat(const ElementProduct<float>& product, Range blocks)
{
    multiplyBlocks(product, blocks);
}

void elementProductDouble(const ElementProduct<double>& product, Range blocks)
{
    multiplyBlocks(product, blocks);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(elementProductFloat);
HWY_EXPORT(elementProductDouble);

template <>
void runElementProduct(const ElementProduct<float>& product, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(elementProductFloat)(product, blocks);
}

template <>
void runElementProduct(const ElementProduct<double>& product, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(elementProductDouble)(product, blocks);
}

}  // namespace bullet_fem
#endif
