// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time. Every sum has the order of panel_kernels.cpp: along a
// row of M column by column; along a column of the panel one partial sum for every kN-th row, added as in sumOfLanes().
#include "fem/factor/panel_kernels.h"

#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/factor/batch_panel_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/factor/panel_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// sums += (rows of M) x.
struct MultiplySide
{
    const Panel& m_panel;
    const float* m_x;
    float* m_sums;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        for (int h = 0; h < kPanelLanes; h += kN)
        {
            V x[C];
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c) x[c] = hn::Load(d, m_x + (firstColumn + c) * kPanelLanes + h);
            for (int r = 0; r < m_panel.m_rowsBelow; ++r)
            {
                const float* entries = entriesOfRow<C>(values, r);
                float* sum = m_sums + r * kPanelLanes + h;
                V s = firstColumn == 0 ? hn::Zero(d) : hn::Load(d, sum);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c) s = hn::MulAdd(hn::Set(d, entries[c * kPanelLanes]), x[c], s);
                hn::Store(s, d, sum);
            }
        }
    }
};

/// out_c = (column c of the panel) . rows.
struct MultiplyTransposedSide
{
    const float* m_rows;  // rows of the panel
    float* m_parts;       // kN / 2 partial sums of every column of a chunk
    float* m_out;
    int m_rowCount;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        for (int h = 0; h < kPanelLanes; h += kN)
        {
            if constexpr (kN >= 2)
                for (int k = 0; k < kN / 2; ++k) sumTwo<C>(k, h, values);
            else
                sumOne<C>(h, values);
            const D d;
            for (int half = kN / 4; half > 0; half /= 2)
                for (int i = 0; i < half * C; ++i)
                {
                    float* part = m_parts + i * kPanelLanes;
                    hn::Store(hn::Add(hn::Load(d, part), hn::Load(d, part + half * C * kPanelLanes)), d, part);
                }
            HWY_UNROLL(12)
            for (int c = 0; c < C; ++c)
                hn::Store(hn::Load(d, m_parts + c * kPanelLanes), d, m_out + (firstColumn + c) * kPanelLanes + h);
        }
    }

    // Rows k, k + kN, ... and k + kN / 2, ... of all columns in separate sums, which are then added.
    template <int C>
    HWY_INLINE void sumTwo(int k, int h, const float* values) const
    {
        const D d;
        V low[C], high[C];
        HWY_UNROLL(12)
        for (int c = 0; c < C; ++c) low[c] = high[c] = hn::Zero(d);
        for (int r = k; r < m_rowCount; r += kN)
        {
            addRow<C>(r, h, values, low);
            if (r + kN / 2 < m_rowCount) addRow<C>(r + kN / 2, h, values, high);
        }
        HWY_UNROLL(12)
        for (int c = 0; c < C; ++c) hn::Store(hn::Add(low[c], high[c]), d, m_parts + (k * C + c) * kPanelLanes);
    }

    template <int C>
    HWY_INLINE void sumOne(int h, const float* values) const
    {
        const D d;
        V sum[C];
        HWY_UNROLL(12)
        for (int c = 0; c < C; ++c) sum[c] = hn::Zero(d);
        for (int r = 0; r < m_rowCount; ++r) addRow<C>(r, h, values, sum);
        HWY_UNROLL(12)
        for (int c = 0; c < C; ++c) hn::Store(sum[c], d, m_parts + c * kPanelLanes);
    }

    template <int C>
    HWY_INLINE void addRow(int r, int h, const float* values, V (&sum)[C]) const
    {
        const D d;
        const float* entries = entriesOfRow<C>(values, r);
        const V row = hn::Load(d, m_rows + r * kPanelLanes + h);
        HWY_UNROLL(12)
        for (int c = 0; c < C; ++c) sum[c] = hn::MulAdd(hn::Set(d, entries[c * kPanelLanes]), row, sum[c]);
    }
};

void ForwardPanelSide(const Panel& panel, float* y, float* scratch)
{
    const D d;
    if (panel.m_rowsBelow == 0) return;
    forEachChunk<3>(panel, MultiplySide{panel, y + static_cast<std::size_t>(panel.m_firstNode) * kNodeLanes, scratch});
    for (int r = 0; r < panel.m_rowsBelow; r += 3)
    {
        float* yr = y + static_cast<std::size_t>(panel.m_row[r / 3]) * kNodeLanes;
        const float* sums = scratch + r * kPanelLanes;
        for (int i = 0; i < kNodeLanes; i += kN)
            hn::Store(hn::Sub(hn::Load(d, yr + i), hn::Load(d, sums + i)), d, yr + i);
    }
}

void BackwardPanelSide(const Panel& panel, float* y, float* scratch)
{
    const D d;
    float* own = y + static_cast<std::size_t>(panel.m_firstNode) * kNodeLanes;
    float* rows = scratch;
    for (int r = 0; r < panel.m_rowsBelow; r += 3, rows += kNodeLanes)
    {
        const float* yr = y + static_cast<std::size_t>(panel.m_row[r / 3]) * kNodeLanes;
        for (int i = 0; i < kNodeLanes; i += kN) hn::Store(hn::Neg(hn::Load(d, yr + i)), d, rows + i);
    }
    const int rowCount = panel.m_rowsBelow + panel.m_columns;
    for (int i = 0; i < panel.m_columns * kPanelLanes; i += kN) hn::Store(hn::Load(d, own + i), d, rows + i);
    forEachChunk<3>(panel, MultiplyTransposedSide{scratch, scratch + rowCount * kPanelLanes, own, rowCount});
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(ForwardPanelSide, void forwardPanelBatch(const Panel& panel, float* y, float* scratch), panel, y,
                 scratch)
BULLETFEM_EXPORT(BackwardPanelSide, void backwardPanelBatch(const Panel& panel, float* y, float* scratch), panel, y,
                 scratch)

}  // namespace bullet_fem
#endif
