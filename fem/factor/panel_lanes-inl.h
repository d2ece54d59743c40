// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Panels applied to 16 right-hand sides at a time. Included once for every instruction set. RowsOfNode is 3 if an entry
// belongs to one direction, and 1 if it serves all three; a node has three times 16 numbers in either case.
#if defined(BULLETFEM_PANEL_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_PANEL_LANES_INL_H
#undef BULLETFEM_PANEL_LANES_INL_H
#else
#define BULLETFEM_PANEL_LANES_INL_H
#endif

#include <hwy/cache_control.h>
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
constexpr int kNodeLanes = 3 * kPanelLanes;  // numbers per node in a batch

/// Sum of all lanes, adding the upper half to the lower until one is left: (0 + 2) + (1 + 3), the order of batches.
/// Equals Highway's SumOfLanes except on NEON, which adds neighbours first.
HWY_INLINE float sumOfLanes(V v)
{
#if HWY_TARGET != HWY_SCALAR
    if constexpr (kN == 4)
    {
        v = hn::Add(v, hn::Shuffle1032(v));
        return hn::GetLane(hn::Add(v, hn::Shuffle2301(v)));
    }
#endif
    return hn::GetLane(hn::SumOfLanes(D(), v));
}

/// Calls run for the last chunk, of `width` columns: fewer than a full chunk.
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

/// Entry (r, 0) of a chunk of C columns; the entries of its row are kPanelLanes apart.
template <int C>
HWY_INLINE const float* entriesOfRow(const float* values, int r)
{
    return values + static_cast<std::size_t>(r / kPanelLanes) * C * kPanelLanes + r % kPanelLanes;
}

constexpr int kAhead = 1536;  // floats that 16 right-hand sides process during the latency of memory

/// Prefetches a sixteenth of the block kAhead after that of row r, farther than hardware prefetchers look. May point
/// beyond the factor. Not needed for isotropic factors, which are small and in the caches.
template <int RowsOfNode, int C>
HWY_INLINE void prefetchAhead(const float* values, int r)
{
    if constexpr (RowsOfNode == 3) hwy::Prefetch(values + static_cast<std::size_t>(r) * C + kAhead);
}

/// y_below -= M x, with the x of a chunk in registers.
template <int RowsOfNode>
struct SubtractLanes
{
    static constexpr int kLanes = kNodeLanes / RowsOfNode;  // numbers per row
    const Panel& m_panel;
    const float* m_x;
    float* m_y;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        for (int h = 0; h < kLanes; h += kN)
        {
            V x[C];
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c) x[c] = hn::Load(d, m_x + (firstColumn + c) * kLanes + h);
            for (int r = 0; r < m_panel.m_rowsBelow; r += RowsOfNode)
            {
                float* y = m_y + static_cast<std::size_t>(m_panel.m_row[r / RowsOfNode]) * kNodeLanes + h;
                HWY_UNROLL(3)
                for (int i = 0; i < RowsOfNode; ++i)
                {
                    const float* entries = entriesOfRow<C>(values, r + i);
                    prefetchAhead<RowsOfNode, C>(values, r + i);
                    V rest = hn::Load(d, y + i * kLanes);
                    HWY_UNROLL(12)
                    for (int c = 0; c < C; ++c) rest = hn::NegMulAdd(hn::Set(d, entries[c * kPanelLanes]), x[c], rest);
                    hn::Store(rest, d, y + i * kLanes);
                }
            }
        }
    }
};

/// out_c = (column c of S) . own - (column c of M) . y_below, with the sums of a chunk in registers.
template <int RowsOfNode>
struct MultiplyTransposedLanes
{
    static constexpr int kLanes = kNodeLanes / RowsOfNode;
    const Panel& m_panel;
    const float* m_y;
    const float* m_own;
    float* m_out;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        for (int h = 0; h < kLanes; h += kN)
        {
            V sum[C];
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c) sum[c] = hn::Zero(d);
            for (int r = 0; r < m_panel.m_rowsBelow; r += RowsOfNode)
            {
                const float* y = m_y + static_cast<std::size_t>(m_panel.m_row[r / RowsOfNode]) * kNodeLanes + h;
                HWY_UNROLL(3)
                for (int i = 0; i < RowsOfNode; ++i)
                {
                    const float* entries = entriesOfRow<C>(values, r + i);
                    prefetchAhead<RowsOfNode, C>(values, r + i);
                    const V row = hn::Load(d, y + i * kLanes);
                    HWY_UNROLL(12)
                    for (int c = 0; c < C; ++c)
                        sum[c] = hn::NegMulAdd(hn::Set(d, entries[c * kPanelLanes]), row, sum[c]);
                }
            }
            for (int r = 0; r < m_panel.m_columns; ++r)
            {
                const float* entries = entriesOfRow<C>(values, m_panel.m_rowsBelow + r);
                prefetchAhead<RowsOfNode, C>(values, m_panel.m_rowsBelow + r);
                const V row = hn::Load(d, m_own + r * kLanes + h);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c) sum[c] = hn::MulAdd(hn::Set(d, entries[c * kPanelLanes]), row, sum[c]);
            }
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c) hn::Store(sum[c], d, m_out + (firstColumn + c) * kLanes + h);
        }
    }
};

template <int RowsOfNode>
HWY_INLINE void forwardLanes(const Panel& panel, float* y)
{
    const float* own = y + static_cast<std::size_t>(panel.m_firstNode) * kNodeLanes;
    forEachChunk<RowsOfNode>(panel, SubtractLanes<RowsOfNode>{panel, own, y});
}

template <int RowsOfNode>
HWY_INLINE void backwardLanes(const Panel& panel, float* y, float* scratch)
{
    float* own = y + static_cast<std::size_t>(panel.m_firstNode) * kNodeLanes;
    std::copy(own, own + panel.m_columns * (kNodeLanes / RowsOfNode), scratch);
    forEachChunk<RowsOfNode>(panel, MultiplyTransposedLanes<RowsOfNode>{panel, y, scratch, own});
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
