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

/// out += M x, one right-hand side. An entry serves so many directions, of which `out` has 16 rows in turn: with three
/// arithmetic limits the speed, with one memory.
template <int Directions>
struct Multiply
{
    const float* m_x;
    float* m_out;
    int m_blocks;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        V x[Directions * C], sum[Directions];
        HWY_UNROLL(12)
        for (int k = 0; k < Directions * C; ++k) x[k] = hn::Set(d, m_x[Directions * firstColumn + k]);
        for (int b = 0; b < m_blocks; ++b, values += C * kPanelLanes)
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                float* out = m_out + b * Directions * kPanelLanes + h;
                HWY_UNROLL(3)
                for (int i = 0; i < Directions; ++i) sum[i] = hn::Load(d, out + i * kPanelLanes);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c)
                {
                    const V m = hn::Load(d, values + c * kPanelLanes + h);
                    HWY_UNROLL(3)
                    for (int i = 0; i < Directions; ++i) sum[i] = hn::MulAdd(m, x[Directions * c + i], sum[i]);
                }
                HWY_UNROLL(3)
                for (int i = 0; i < Directions; ++i) hn::Store(sum[i], d, out + i * kPanelLanes);
            }
    }
};

/// out_c = (column c of the panel) . rows, one right-hand side.
template <int Directions>
struct MultiplyTransposed
{
    const float* m_rows;
    float* m_out;
    int m_blocks;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        V sum[Directions * C], row[Directions];
        HWY_UNROLL(12)
        for (int k = 0; k < Directions * C; ++k) sum[k] = hn::Zero(d);
        for (int b = 0; b < m_blocks; ++b, values += C * kPanelLanes)
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                const float* rows = m_rows + b * Directions * kPanelLanes + h;
                HWY_UNROLL(3)
                for (int i = 0; i < Directions; ++i) row[i] = hn::Load(d, rows + i * kPanelLanes);
                HWY_UNROLL(12)
                for (int c = 0; c < C; ++c)
                {
                    const V m = hn::Load(d, values + c * kPanelLanes + h);
                    HWY_UNROLL(3)
                    for (int i = 0; i < Directions; ++i)
                        sum[Directions * c + i] = hn::MulAdd(m, row[i], sum[Directions * c + i]);
                }
            }
        HWY_UNROLL(12)
        for (int k = 0; k < Directions * C; ++k) m_out[Directions * firstColumn + k] = sumOfLanes(sum[k]);
    }
};

void ForwardPanel(const Panel& panel, float* y, float* scratch)
{
    const D d;
    const int blocks = panel.blocksBelow();
    for (int i = 0; i < blocks * kPanelLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + i);
    forEachChunk<3>(panel, Multiply<1>{y + 3 * static_cast<std::size_t>(panel.m_firstNode), scratch, blocks});
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
    forEachChunk<3>(panel, MultiplyTransposed<1>{scratch, own, panel.blocks()});
}

void ForwardPanelLanes(const Panel& panel, float* y, float*)
{
    forwardLanes<3>(panel, y);
}

void BackwardPanelLanes(const Panel& panel, float* y, float* scratch)
{
    backwardLanes<3>(panel, y, scratch);
}

/// Start of row r of one right-hand side in the scratch; its directions are kPanelLanes apart.
HWY_INLINE std::size_t place(int r)
{
    return static_cast<std::size_t>(r / kPanelLanes) * kNodeLanes + r % kPanelLanes;
}

void ForwardIsotropic(const Panel& panel, float* y, float* scratch)
{
    const D d;
    const int blocks = panel.blocksBelow();
    for (int i = 0; i < blocks * kNodeLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + i);
    forEachChunk<1>(panel, Multiply<3>{y + 3 * static_cast<std::size_t>(panel.m_firstNode), scratch, blocks});
    for (int r = 0; r < panel.m_rowsBelow; ++r)
    {
        float* yr = y + 3 * static_cast<std::size_t>(panel.m_row[r]);
        const float* sum = scratch + place(r);
        for (int i = 0; i < 3; ++i) yr[i] -= sum[i * kPanelLanes];
    }
}

void BackwardIsotropic(const Panel& panel, float* y, float* scratch)
{
    const D d;
    float* own = y + 3 * static_cast<std::size_t>(panel.m_firstNode);
    const int last = (panel.blocks() - 1) * kNodeLanes;  // only the last block has padding
    for (int i = 0; i < kNodeLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + last + i);
    for (int r = 0; r < panel.m_rowsBelow; ++r)
    {
        const float* yr = y + 3 * static_cast<std::size_t>(panel.m_row[r]);
        float* row = scratch + place(r);
        for (int i = 0; i < 3; ++i) row[i * kPanelLanes] = -yr[i];
    }
    for (int c = 0; c < panel.m_columns; ++c)
    {
        float* row = scratch + place(panel.m_rowsBelow + c);
        for (int i = 0; i < 3; ++i) row[i * kPanelLanes] = own[3 * c + i];
    }
    forEachChunk<1>(panel, MultiplyTransposed<3>{scratch, own, panel.blocks()});
}

void ForwardIsotropicLanes(const Panel& panel, float* y, float*)
{
    forwardLanes<1>(panel, y);
}

void BackwardIsotropicLanes(const Panel& panel, float* y, float* scratch)
{
    backwardLanes<1>(panel, y, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(ForwardPanel, void forwardPanel(const Panel& panel, float* y, float* scratch), panel, y, scratch)
BULLETFEM_EXPORT(BackwardPanel, void backwardPanel(const Panel& panel, float* y, float* scratch), panel, y, scratch)
BULLETFEM_EXPORT(ForwardPanelLanes, void forwardPanelLanes(const Panel& panel, float* y, float* scratch), panel, y,
                 scratch)
BULLETFEM_EXPORT(BackwardPanelLanes, void backwardPanelLanes(const Panel& panel, float* y, float* scratch), panel, y,
                 scratch)
BULLETFEM_EXPORT(ForwardIsotropic, void forwardIsotropic(const Panel& panel, float* y, float* scratch), panel, y,
                 scratch)
BULLETFEM_EXPORT(BackwardIsotropic, void backwardIsotropic(const Panel& panel, float* y, float* scratch), panel, y,
                 scratch)
BULLETFEM_EXPORT(ForwardIsotropicLanes, void forwardIsotropicLanes(const Panel& panel, float* y, float* scratch), panel,
                 y, scratch)
BULLETFEM_EXPORT(BackwardIsotropicLanes, void backwardIsotropicLanes(const Panel& panel, float* y, float* scratch),
                 panel, y, scratch)

}  // namespace bullet_fem
#endif
