// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Transposition of small blocks between the bodies' arrays and the lanes. Included once for every instruction set.
#if defined(BULLETFEM_LANE_EXCHANGE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_LANE_EXCHANGE_INL_H
#undef BULLETFEM_LANE_EXCHANGE_INL_H
#else
#define BULLETFEM_LANE_EXCHANGE_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "fem/body/batch_width.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Number of values exchanged at a time: those of a block of 128 bits.
template <class Real>
constexpr int kBlock = 16 / sizeof(Real);

#if HWY_TARGET == HWY_SCALAR
template <class Real>
constexpr bool kHasBlocks = false;
#else
template <class Real>
constexpr bool kHasBlocks = true;

template <class Real>
using BodyTag = hn::CappedTag<Real, kBatchWidth>;

/// Loads a block from each array and concatenates them.
template <class D>
HWY_INLINE hn::Vec<D> loadBlocks(D d, const hn::TFromD<D>* const* arrays, std::ptrdiff_t at)
{
    constexpr int kBlocks = static_cast<int>(hn::MaxLanes(D())) / kBlock<hn::TFromD<D> >;
    if constexpr (kBlocks == 1)
        return hn::LoadU(d, arrays[0] + at);
    else
    {
        const hn::Half<D> half;
        return hn::Combine(d, loadBlocks(half, arrays + kBlocks / 2, at), loadBlocks(half, arrays, at));
    }
}

/// Splits a vector into blocks and stores one to each array that is not null.
template <class D>
HWY_INLINE void storeBlocks(D d, hn::Vec<D> v, hn::TFromD<D>* const* arrays, std::ptrdiff_t at)
{
    constexpr int kBlocks = static_cast<int>(hn::MaxLanes(D())) / kBlock<hn::TFromD<D> >;
    if constexpr (kBlocks == 1)
    {
        if (arrays[0]) hn::StoreU(v, d, arrays[0] + at);
    }
    else
    {
        const hn::Half<D> half;
        storeBlocks(half, hn::LowerHalf(half, v), arrays, at);
        storeBlocks(half, hn::UpperHalf(half, v), arrays + kBlocks / 2, at);
    }
}

/// Transposes the rows in every block of 128 bits.
HWY_INLINE void transposeBlocks(hn::Vec<BodyTag<float> > (&r)[4])
{
    const BodyTag<float> d;
    const hn::Repartition<double, BodyTag<float> > pairs;
    const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(d, r[0], r[1]));
    const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(d, r[2], r[3]));
    const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(d, r[0], r[1]));
    const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(d, r[2], r[3]));
    r[0] = hn::BitCast(d, hn::InterleaveLower(pairs, low01, low23));
    r[1] = hn::BitCast(d, hn::InterleaveUpper(pairs, low01, low23));
    r[2] = hn::BitCast(d, hn::InterleaveLower(pairs, high01, high23));
    r[3] = hn::BitCast(d, hn::InterleaveUpper(pairs, high01, high23));
}

HWY_INLINE void transposeBlocks(hn::Vec<BodyTag<double> > (&r)[2])
{
    const BodyTag<double> d;
    const auto low = hn::InterleaveLower(d, r[0], r[1]);
    r[1] = hn::InterleaveUpper(d, r[0], r[1]);
    r[0] = low;
}

/// Reads kBlock values of all bodies, starting at index `at` of their arrays.
template <class Real>
HWY_INLINE void gatherBlocks(const Real* const* arrays, std::ptrdiff_t at, Real* lanes, int stride)
{
    const BodyTag<Real> d;
    constexpr int kN = static_cast<int>(hn::MaxLanes(BodyTag<Real>())), kBlocks = kN / kBlock<Real>;
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        hn::Vec<BodyTag<Real> > r[kBlock<Real>];
        HWY_UNROLL(4)
        for (int k = 0; k < kBlock<Real>; ++k)
        {
            const Real* own[kBlocks];
            for (int j = 0; j < kBlocks; ++j) own[j] = arrays[lane + j * kBlock<Real> + k];
            r[k] = loadBlocks(d, own, at);
        }
        transposeBlocks(r);
        HWY_UNROLL(4)
        for (int k = 0; k < kBlock<Real>; ++k) hn::Store(r[k], d, lanes + k * stride + lane);
    }
}

template <class Real>
HWY_INLINE void scatterBlocks(Real* const* arrays, std::ptrdiff_t at, const Real* lanes, int stride)
{
    const BodyTag<Real> d;
    constexpr int kN = static_cast<int>(hn::MaxLanes(BodyTag<Real>())), kBlocks = kN / kBlock<Real>;
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        hn::Vec<BodyTag<Real> > r[kBlock<Real>];
        HWY_UNROLL(4)
        for (int k = 0; k < kBlock<Real>; ++k) r[k] = hn::Load(d, lanes + k * stride + lane);
        transposeBlocks(r);
        HWY_UNROLL(4)
        for (int k = 0; k < kBlock<Real>; ++k)
        {
            Real* own[kBlocks];
            for (int j = 0; j < kBlocks; ++j) own[j] = arrays[lane + j * kBlock<Real> + k];
            storeBlocks(d, r[k], own, at);
        }
    }
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
