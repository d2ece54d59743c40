// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/factor/panel_kernels.h"

#include <algorithm>
#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/factor/panel_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/factor/panel_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
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
        for (int c = 0; c < C; ++c) m_out[firstColumn + c] = sumOfLanes(sum[c]);
    }
};

void ForwardPanel(const Panel& panel, float* y, float* scratch)
{
    const D d;
    const int blocks = panel.blocksBelow();
    for (int i = 0; i < blocks * kPanelLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + i);
    forEachChunk<3>(panel, Multiply{y + 3 * static_cast<std::size_t>(panel.m_firstNode), scratch, blocks});
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
    forEachChunk<3>(panel, MultiplyTransposed{scratch, own, panel.blocks()});
}

void ForwardPanelLanes(const Panel& panel, float* y, float*)
{
    forwardLanes<3>(panel, y);
}

void BackwardPanelLanes(const Panel& panel, float* y, float* scratch)
{
    backwardLanes<3>(panel, y, scratch);
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
