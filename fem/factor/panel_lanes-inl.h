// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Panels and 16 right-hand sides at a time. Included once for every instruction set. RowsOfNode is 3 where an entry
// stands for one direction, and 1 where it serves all three; a node has three times 16 numbers in either case.
#if defined(BULLETFEM_PANEL_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_PANEL_LANES_INL_H
#undef BULLETFEM_PANEL_LANES_INL_H
#else
#define BULLETFEM_PANEL_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "fem/factor/panel_kernels.h"

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
constexpr int kNodeLanes = 3 * kPanelLanes;   // of a node in a batch

/// Calls run for the last chunk, of `width` columns: less than a whole one.
template <int Width, int Unit, class Run>
HWY_INLINE void runLastChunk(int width, int column, const float* values, const Run& run)
{
    if constexpr (Width > 0)
    {
        if (width == Width)
            run(std::integral_constant<int, Width>(), column, values);
        else
            runLastChunk<Width - Unit, Unit>(width, column, values, run);
    }
}

/// Calls run(width of the chunk as a constant, its first column, its values) for every chunk of 4 nodes' columns.
template <int RowsOfNode, class Run>
HWY_INLINE void forEachChunk(const Panel& panel, const Run& run)
{
    constexpr int kWidth = 4 * RowsOfNode;
    const float* values = panel.m_values;
    const std::size_t stride = static_cast<std::size_t>(panel.blocks()) * kPanelLanes;
    int c = 0;
    for (; c + kWidth <= panel.m_columns; c += kWidth, values += kWidth * stride)
        run(std::integral_constant<int, kWidth>(), c, values);
    runLastChunk<kWidth - RowsOfNode, RowsOfNode>(panel.m_columns - c, c, values, run);
}

/// out += (rows of M) x: kRows rows at a time.
template <int RowsOfNode>
struct MultiplyLanes
{
    static constexpr int kLanes = kNodeLanes / RowsOfNode;  // of a row
    const float* m_x;
    float* m_out;
    int m_rows;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        const float* x = m_x + static_cast<std::size_t>(firstColumn) * kLanes;
        for (int r = 0; r < m_rows; r += kRows)
        {
            const float* entries = values + (r / kPanelLanes) * C * kPanelLanes + r % kPanelLanes;
            for (int h = 0; h < kLanes; h += kN)
            {
                float* out = m_out + r * kLanes + h;
                V sum[kRows];
                HWY_UNROLL(8)
                for (int i = 0; i < kRows; ++i) sum[i] = hn::Load(d, out + i * kLanes);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c)
                {
                    const V xc = hn::Load(d, x + c * kLanes + h);
                    HWY_UNROLL(8)
                    for (int i = 0; i < kRows; ++i)
                        sum[i] = hn::MulAdd(hn::Set(d, entries[c * kPanelLanes + i]), xc, sum[i]);
                }
                HWY_UNROLL(8)
                for (int i = 0; i < kRows; ++i) hn::Store(sum[i], d, out + i * kLanes);
            }
        }
    }
};

/// out_c = (column c of the panel) . rows.
template <int RowsOfNode>
struct MultiplyTransposedLanes
{
    static constexpr int kLanes = kNodeLanes / RowsOfNode;
    const float* m_rows;
    float* m_out;
    int m_rowCount;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        for (int h = 0; h < kLanes; h += kN)
        {
            V sum[C];
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c) sum[c] = hn::Zero(d);
            for (int r = 0; r < m_rowCount; ++r)
            {
                const float* entries = values + (r / kPanelLanes) * C * kPanelLanes + r % kPanelLanes;
                const V row = hn::Load(d, m_rows + r * kLanes + h);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c) sum[c] = hn::MulAdd(hn::Set(d, entries[c * kPanelLanes]), row, sum[c]);
            }
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c) hn::Store(sum[c], d, m_out + (firstColumn + c) * kLanes + h);
        }
    }
};

template <int RowsOfNode>
HWY_INLINE void forwardLanes(const Panel& panel, float* y, float* scratch)
{
    const D d;
    constexpr int kLanes = kNodeLanes / RowsOfNode;
    const int rows = (panel.m_rowsBelow + kRows - 1) / kRows * kRows;
    for (int i = 0; i < rows * kLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + i);
    const float* own = y + static_cast<std::size_t>(panel.m_firstNode) * kNodeLanes;
    forEachChunk<RowsOfNode>(panel, MultiplyLanes<RowsOfNode>{own, scratch, rows});
    for (int k = 0; k < panel.m_rowsBelow / RowsOfNode; ++k)
    {
        float* yk = y + static_cast<std::size_t>(panel.m_row[k]) * kNodeLanes;
        for (int i = 0; i < kNodeLanes; i += kN)
            hn::Store(hn::Sub(hn::Load(d, yk + i), hn::Load(d, scratch + k * kNodeLanes + i)), d, yk + i);
    }
}

template <int RowsOfNode>
HWY_INLINE void backwardLanes(const Panel& panel, float* y, float* scratch)
{
    const D d;
    constexpr int kLanes = kNodeLanes / RowsOfNode;
    float* own = y + static_cast<std::size_t>(panel.m_firstNode) * kNodeLanes;
    for (int k = 0; k < panel.m_rowsBelow / RowsOfNode; ++k)
    {
        const float* yk = y + static_cast<std::size_t>(panel.m_row[k]) * kNodeLanes;
        for (int i = 0; i < kNodeLanes; i += kN)
            hn::Store(hn::Neg(hn::Load(d, yk + i)), d, scratch + k * kNodeLanes + i);
    }
    std::copy(own, own + panel.m_columns * kLanes, scratch + panel.m_rowsBelow * kLanes);
    forEachChunk<RowsOfNode>(panel,
                             MultiplyTransposedLanes<RowsOfNode>{scratch, own, panel.m_rowsBelow + panel.m_columns});
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
