// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/factor/panel_kernels.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/factor/panel_kernels.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kPanelLanes>;
using V = hn::Vec<D>;
constexpr int kN = static_cast<int>(hn::MaxLanes(D()));
constexpr int kRows = HWY_CAP_GE512 ? 8 : 4;  // of a batch that fit into the registers; divides kPanelLanes

/// Calls run(width of the chunk as a constant, its first column, its values) for every chunk of columns.
template <class Run>
HWY_INLINE void forEachChunk(const Panel& panel, const Run& run)
{
    const float* values = panel.m_values;
    const std::size_t stride = static_cast<std::size_t>(panel.blocks()) * kPanelLanes;
    int c = 0;
    for (; c + 12 <= panel.m_columns; c += 12, values += 12 * stride) run(std::integral_constant<int, 12>(), c, values);
    switch (panel.m_columns - c)
    {
        case 9:
            return run(std::integral_constant<int, 9>(), c, values);
        case 6:
            return run(std::integral_constant<int, 6>(), c, values);
        case 3:
            return run(std::integral_constant<int, 3>(), c, values);
        default:
            return;
    }
}

/// out += (rows of M) x, one right-hand side.
struct Multiply
{
    const float* m_x;
    float* m_out;
    int m_blocks;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        V x[C];
        HWY_UNROLL(12)
        for (int c = 0; c < C; ++c) x[c] = hn::Set(d, m_x[firstColumn + c]);
        for (int b = 0; b < m_blocks; ++b, values += C * kPanelLanes)
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                float* out = m_out + b * kPanelLanes + h;
                V sum = hn::Load(d, out);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c) sum = hn::MulAdd(hn::Load(d, values + c * kPanelLanes + h), x[c], sum);
                hn::Store(sum, d, out);
            }
    }
};

/// out_c = (column c of the panel) . rows, one right-hand side.
struct MultiplyTransposed
{
    const float* m_rows;
    float* m_out;
    int m_blocks;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        V sum[C];
        HWY_UNROLL(12)
        for (int c = 0; c < C; ++c) sum[c] = hn::Zero(d);
        for (int b = 0; b < m_blocks; ++b, values += C * kPanelLanes)
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                const V row = hn::Load(d, m_rows + b * kPanelLanes + h);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c) sum[c] = hn::MulAdd(hn::Load(d, values + c * kPanelLanes + h), row, sum[c]);
            }
        HWY_UNROLL(12)
        for (int c = 0; c < C; ++c) m_out[firstColumn + c] = hn::GetLane(hn::SumOfLanes(d, sum[c]));
    }
};

void ForwardPanel(const Panel& panel, float* y, float* scratch)
{
    const D d;
    const int blocks = panel.blocksBelow();
    for (int i = 0; i < blocks * kPanelLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + i);
    forEachChunk(panel, Multiply{y + 3 * static_cast<std::size_t>(panel.m_firstNode), scratch, blocks});
    for (int r = 0; r < panel.m_rowsBelow; r += 3)
    {
        float* yr = y + 3 * static_cast<std::size_t>(panel.m_row[r / 3]);
        for (int i = 0; i < 3; ++i) yr[i] -= scratch[r + i];
    }
}

void BackwardPanel(const Panel& panel, float* y, float* scratch)
{
    float* own = y + 3 * static_cast<std::size_t>(panel.m_firstNode);
    float* rows = scratch;
    for (int r = 0; r < panel.m_rowsBelow; r += 3)
    {
        const float* yr = y + 3 * static_cast<std::size_t>(panel.m_row[r / 3]);
        for (int i = 0; i < 3; ++i) *rows++ = -yr[i];
    }
    rows = std::copy(own, own + panel.m_columns, rows);
    std::fill(rows, scratch + panel.blocks() * kPanelLanes, 0.f);
    forEachChunk(panel, MultiplyTransposed{scratch, own, panel.blocks()});
}

/// As Multiply, for 16 right-hand sides: kRows rows at a time.
struct MultiplyLanes
{
    const float* m_x;
    float* m_out;
    int m_rows;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        const float* x = m_x + static_cast<std::size_t>(firstColumn) * kPanelLanes;
        for (int r = 0; r < m_rows; r += kRows)
        {
            const float* entries = values + (r / kPanelLanes) * C * kPanelLanes + r % kPanelLanes;
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                float* out = m_out + r * kPanelLanes + h;
                V sum[kRows];
                HWY_UNROLL(8)
                for (int i = 0; i < kRows; ++i) sum[i] = hn::Load(d, out + i * kPanelLanes);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c)
                {
                    const V xc = hn::Load(d, x + c * kPanelLanes + h);
                    HWY_UNROLL(8)
                    for (int i = 0; i < kRows; ++i)
                        sum[i] = hn::MulAdd(hn::Set(d, entries[c * kPanelLanes + i]), xc, sum[i]);
                }
                HWY_UNROLL(8)
                for (int i = 0; i < kRows; ++i) hn::Store(sum[i], d, out + i * kPanelLanes);
            }
        }
    }
};

/// As MultiplyTransposed, for 16 right-hand sides.
struct MultiplyTransposedLanes
{
    const float* m_rows;
    float* m_out;
    int m_rowCount;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        for (int h = 0; h < kPanelLanes; h += kN)
        {
            V sum[C];
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c) sum[c] = hn::Zero(d);
            for (int r = 0; r < m_rowCount; ++r)
            {
                const float* entries = values + (r / kPanelLanes) * C * kPanelLanes + r % kPanelLanes;
                const V row = hn::Load(d, m_rows + r * kPanelLanes + h);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c) sum[c] = hn::MulAdd(hn::Set(d, entries[c * kPanelLanes]), row, sum[c]);
            }
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c) hn::Store(sum[c], d, m_out + (firstColumn + c) * kPanelLanes + h);
        }
    }
};

void ForwardPanelLanes(const Panel& panel, float* y, float* scratch)
{
    const D d;
    const int rows = (panel.m_rowsBelow + kRows - 1) / kRows * kRows;
    for (int i = 0; i < rows * kPanelLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + i);
    const std::size_t first = 3 * static_cast<std::size_t>(panel.m_firstNode);
    forEachChunk(panel, MultiplyLanes{y + first * kPanelLanes, scratch, rows});
    for (int r = 0; r < panel.m_rowsBelow; r += 3)
    {
        float* yr = y + 3 * static_cast<std::size_t>(panel.m_row[r / 3]) * kPanelLanes;
        for (int i = 0; i < 3 * kPanelLanes; i += kN)
            hn::Store(hn::Sub(hn::Load(d, yr + i), hn::Load(d, scratch + r * kPanelLanes + i)), d, yr + i);
    }
}

void BackwardPanelLanes(const Panel& panel, float* y, float* scratch)
{
    const D d;
    float* own = y + 3 * static_cast<std::size_t>(panel.m_firstNode) * kPanelLanes;
    for (int r = 0; r < panel.m_rowsBelow; r += 3)
    {
        const float* yr = y + 3 * static_cast<std::size_t>(panel.m_row[r / 3]) * kPanelLanes;
        for (int i = 0; i < 3 * kPanelLanes; i += kN)
            hn::Store(hn::Neg(hn::Load(d, yr + i)), d, scratch + r * kPanelLanes + i);
    }
    std::copy(own, own + panel.m_columns * kPanelLanes, scratch + panel.m_rowsBelow * kPanelLanes);
    forEachChunk(panel, MultiplyTransposedLanes{scratch, own, panel.m_rowsBelow + panel.m_columns});
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(ForwardPanel);
HWY_EXPORT(BackwardPanel);
HWY_EXPORT(ForwardPanelLanes);
HWY_EXPORT(BackwardPanelLanes);

void forwardPanel(const Panel& panel, float* y, float* scratch)
{
    HWY_DYNAMIC_DISPATCH(ForwardPanel)(panel, y, scratch);
}

void backwardPanel(const Panel& panel, float* y, float* scratch)
{
    HWY_DYNAMIC_DISPATCH(BackwardPanel)(panel, y, scratch);
}

void forwardPanelLanes(const Panel& panel, float* y, float* scratch)
{
    HWY_DYNAMIC_DISPATCH(ForwardPanelLanes)(panel, y, scratch);
}

void backwardPanelLanes(const Panel& panel, float* y, float* scratch)
{
    HWY_DYNAMIC_DISPATCH(BackwardPanelLanes)(panel, y, scratch);
}

}  // namespace bullet_fem
#endif
