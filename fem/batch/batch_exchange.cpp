// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/batch/batch_exchange.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/batch/batch_exchange.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/batch/batch_exchange-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
/// Calls some(at, place) for full exchange blocks, `at` in a body's array and `place` in the lanes, and one(at, place)
/// for remaining values, in the order of the bodies' arrays, which are the farther memory.
template <class Real, class Some, class One>
HWY_INLINE void forEachBlock(const BatchLayout& layout, const Some& some, const One& one)
{
    const std::ptrdiff_t rows = layout.m_rows, stride = rows * kBatchWidth;
    const std::ptrdiff_t run = rows > 1 ? kLanes : layout.m_count;
    for (std::ptrdiff_t first = 0; first < layout.m_count; first += run)
        for (std::ptrdiff_t row = 0; row < rows; ++row)
        {
            std::ptrdiff_t value = first, at = first * rows + row * run;
            const std::ptrdiff_t end = HWY_MIN(first + run, static_cast<std::ptrdiff_t>(layout.m_count));
            if constexpr (kHasBlocks<Real>)
                for (; value + kBlock<Real> <= end; value += kBlock<Real>, at += kBlock<Real>)
                    some(at, value * stride + row * kBatchWidth);
            for (; value < end; ++value, ++at) one(at, value * stride + row * kBatchWidth);
        }
}

template <class Real>
HWY_INLINE void gather(const Real* const* arrays, Real* lanes, const BatchLayout& layout)
{
    const auto some = [&](std::ptrdiff_t at, std::ptrdiff_t place)
    {
        if constexpr (kHasBlocks<Real>) gatherBlocks(arrays, at, lanes + place, layout.m_rows * kBatchWidth);
    };
    const auto one = [&](std::ptrdiff_t at, std::ptrdiff_t place)
    {
        for (int b = 0; b < kBatchWidth; ++b) lanes[place + b] = arrays[b][at];
    };
    forEachBlock<Real>(layout, some, one);
}

template <class Real>
HWY_INLINE void scatter(Real* const* arrays, const Real* lanes, const BatchLayout& layout)
{
    const auto some = [&](std::ptrdiff_t at, std::ptrdiff_t place)
    {
        if constexpr (kHasBlocks<Real>) scatterBlocks(arrays, at, lanes + place, layout.m_rows * kBatchWidth);
    };
    const auto one = [&](std::ptrdiff_t at, std::ptrdiff_t place)
    {
        for (int b = 0; b < kBatchWidth; ++b)
            if (arrays[b]) arrays[b][at] = lanes[place + b];
    };
    forEachBlock<Real>(layout, some, one);
}

void GatherFloats(const float* const* arrays, float* lanes, const BatchLayout& layout)
{
    gather(arrays, lanes, layout);
}

void GatherDoubles(const double* const* arrays, double* lanes, const BatchLayout& layout)
{
    gather(arrays, lanes, layout);
}

void ScatterFloats(float* const* arrays, const float* lanes, const BatchLayout& layout)
{
    scatter(arrays, lanes, layout);
}

void ScatterDoubles(double* const* arrays, const double* lanes, const BatchLayout& layout)
{
    scatter(arrays, lanes, layout);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(GatherFloats, void gatherBatch(const float* const* arrays, float* lanes, const BatchLayout& layout),
                 arrays, lanes, layout)
BULLETFEM_EXPORT(GatherDoubles, void gatherBatch(const double* const* arrays, double* lanes, const BatchLayout& layout),
                 arrays, lanes, layout)
BULLETFEM_EXPORT(ScatterFloats, void scatterBatch(float* const* arrays, const float* lanes, const BatchLayout& layout),
                 arrays, lanes, layout)
BULLETFEM_EXPORT(ScatterDoubles,
                 void scatterBatch(double* const* arrays, const double* lanes, const BatchLayout& layout), arrays,
                 lanes, layout)

}  // namespace bullet_fem
#endif
