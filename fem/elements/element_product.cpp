// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/elements/element_product.h"

#include "fem/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/element_product.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/lanes-inl.h"

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
    scalar::runElementProduct(product, blocks);
}

#else

/// lambda tr(H) I + mu (H + H^T) + H T.
template <class Real>
HWY_INLINE Matrix<Real> warpedStress(const WarpedBlock<Real>& element, int lane, const Matrix<Real>& H)
{
    using V = Vector<Real>;
    const Lanes<Real> d;
    const auto& t = element.m_tension;
    const V xx = hn::Load(d, t[0] + lane), yy = hn::Load(d, t[1] + lane), zz = hn::Load(d, t[2] + lane);
    const V yz = hn::Load(d, t[3] + lane), xz = hn::Load(d, t[4] + lane), xy = hn::Load(d, t[5] + lane);
    const V mu = hn::Load(d, element.m_mu + lane);
    const V pressure = hn::Load(d, element.m_lambda + lane) * (H.m[0][0] + H.m[1][1] + H.m[2][2]);
    Matrix<Real> P;
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i)
    {
        const V a = H.m[i][0], b = H.m[i][1], c = H.m[i][2];
        P.m[i][0] = hn::MulAdd(mu, a + H.m[0][i], dot3(a, xx, b, xy, c, xz));
        P.m[i][1] = hn::MulAdd(mu, b + H.m[1][i], dot3(a, xy, b, yy, c, yz));
        P.m[i][2] = hn::MulAdd(mu, c + H.m[2][i], dot3(a, xz, b, yz, c, zz));
        P.m[i][i] = P.m[i][i] + pressure;
    }
    return P;
}

template <class Real>
HWY_INLINE void multiplyBlocks(const ElementProduct<Real>& product, Range blocks)
{
    StagedEdges<Real> edges[2];
    const auto stage = [&](int b, int lane, int slot)
    { edges[slot].stage(product.m_elements->m_blocks[b].m_node + lane, product.m_p); };
    const auto compute = [&](int b, int lane, int slot)
    {
        const WarpedBlock<Real>& element = product.m_warped[b];
        const Matrix<Real> g = loadMatrix(element.m_gradient, lane);  // row a is g'_a
        const Matrix<Real> H = times(edges[slot].load(), g);
        storeCorners(timesTranspose(warpedStress(element, lane, H), g), product.m_out[b], lane);
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
