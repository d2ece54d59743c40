// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/common/vector_targets.h"
#include "fem/elements/orthotropic_elements.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/orthotropic_product.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/orthotropic_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// For processors without vector instructions.
template <class Real>
void multiplyOrthotropic(const OrthotropicProduct<Real>& product, Range blocks)
{
    reference::runOrthotropicProduct(product, blocks);
}

#else

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
        lanes.m_stretch = loadSymmetricRows(warped.m_stretch, lane);
        lanes.m_spin = loadSymmetricRows(warped.m_spin, lane);
        const ElementBlock<Real>& block = elements.m_blocks[b];
        const Vector<Real> lambda = factor * hn::Load(Lanes<Real>(), block.m_lambdaVolume + lane);
        const Vector<Real> mu = factor * hn::Load(Lanes<Real>(), block.m_muVolume + lane);
        const Symmetric<Real> change = times<Real>(lanes.change(H), factor);
        Matrix<Real> P = lanes.balanced(hooke<Real>(lambda, mu, doubledPart(H)),
                                        stiffnessTimes(elements.m_stiffness[b], lane, change));
        const Matrix<Real> HT = times(H, full(loadSymmetricRows(warped.m_tension, lane)));
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) P.m[k / 3][k % 3] = P.m[k / 3][k % 3] + HT.m[k / 3][k % 3];
        storeCorners(times(R, timesTranspose(P, DmInverse)), plain.m_out[b], lane);
    };
    forEachVector<Real>(blocks, stage, compute);
}

#endif

void orthotropicProductFloat(const OrthotropicProduct<float>& product, Range blocks)
{
    multiplyOrthotropic(product, blocks);
}

void orthotropicProductDouble(const OrthotropicProduct<double>& product, Range blocks)
{
    multiplyOrthotropic(product, blocks);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(orthotropicProductFloat);
HWY_EXPORT(orthotropicProductDouble);

template <>
void runOrthotropicProduct(const OrthotropicProduct<float>& product, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(orthotropicProductFloat)(product, blocks);
}

template <>
void runOrthotropicProduct(const OrthotropicProduct<double>& product, Range blocks)
{
    HWY_DYNAMIC_DISPATCH(orthotropicProductDouble)(product, blocks);
}

}  // namespace bullet_fem
#endif
