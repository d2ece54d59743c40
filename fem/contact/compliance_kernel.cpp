// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/contact/compliance_kernel.h"

#include "fem/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/contact/compliance_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, kNodePadding>;
using Vector = hn::Vec<Lanes>;

// Of rows of three.
HWY_INLINE Vector dot3(const Vector* a, const Vector* b)
{
    return hn::MulAdd(a[2], b[2], hn::MulAdd(a[1], b[1], hn::Mul(a[0], b[0])));
}

void TurnColumn(const RestColumn& in, float* columns)
{
    const Lanes d;
    const hn::RebindToSigned<Lanes> di;
    Vector source[9];
    for (int k = 0; k < 9; ++k) source[k] = hn::Set(d, in.m_source[k]);
    for (std::size_t i = in.m_first; i < in.m_padded; i += hn::Lanes(d))
    {
        const auto offset = hn::LoadU(di, in.m_offsets + i);
        Vector half[3][3];  // half[c][m] = ((A0^-1) R_j^T)_mc
        for (int m = 0; m < 3; ++m)
        {
            Vector row[3];
            for (int n = 0; n < 3; ++n) row[n] = hn::GatherIndex(d, in.m_blocks + 3 * m + n, offset);
            for (int c = 0; c < 3; ++c) half[c][m] = dot3(row, &source[3 * c]);
        }
        Vector rotation[9];
        for (int k = 0; k < 9; ++k) rotation[k] = hn::LoadU(d, in.m_rotations + k * in.m_padded + i);
        for (int c = 0; c < 3; ++c)
            hn::StoreInterleaved3(dot3(&rotation[0], half[c]), dot3(&rotation[3], half[c]), dot3(&rotation[6], half[c]),
                                  d, columns + 3 * (c * in.m_padded + i));
    }
}

void AddWeighted(const WeightedArrays& in, std::size_t size, float* sum)
{
    const hn::ScalableTag<float> d;
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= size; i += hn::Lanes(d))
    {
        auto s = hn::Zero(d);
        for (int k = 0; k < in.m_count; ++k)
            s = hn::MulAdd(hn::Set(d, in.m_weights[k]), hn::LoadU(d, in.m_arrays[k] + i), s);
        hn::StoreU(s, d, sum + i);
    }
    for (; i < size; ++i)
    {
        sum[i] = 0;
        for (int k = 0; k < in.m_count; ++k) sum[i] += in.m_weights[k] * in.m_arrays[k][i];
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(TurnColumn);
HWY_EXPORT(AddWeighted);

void turnColumn(const RestColumn& column, float* columns)
{
    HWY_DYNAMIC_DISPATCH(TurnColumn)(column, columns);
}

void addWeighted(const WeightedArrays& arrays, std::size_t size, float* sum)
{
    HWY_DYNAMIC_DISPATCH(AddWeighted)(arrays, size, sum);
}

void scalar::turnColumn(const RestColumn& in, float* columns)
{
    for (std::size_t i = in.m_first; i < in.m_padded; ++i)
    {
        const float* block = in.m_blocks + in.m_offsets[i];
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < 3; ++k)
            {
                float sum = 0;
                for (int m = 0; m < 3; ++m)
                    for (int n = 0; n < 3; ++n)
                        sum +=
                            in.m_rotations[(3 * k + m) * in.m_padded + i] * block[3 * m + n] * in.m_source[3 * c + n];
                columns[3 * (c * in.m_padded + i) + k] = sum;
            }
    }
}

void scalar::addWeighted(const WeightedArrays& in, std::size_t size, float* sum)
{
    for (std::size_t i = 0; i < size; ++i)
    {
        sum[i] = 0;
        for (int k = 0; k < in.m_count; ++k) sum[i] += in.m_weights[k] * in.m_arrays[k][i];
    }
}

}  // namespace bullet_fem
#endif
