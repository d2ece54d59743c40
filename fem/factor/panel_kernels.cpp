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

// One entry of an isotropic panel serves three directions, so these kernels are limited by arithmetic where those above
// are limited by memory.

/// out += M x, one right-hand side; out has 16 rows of each direction in turn.
struct IsotropicMultiply
{
    const float* m_x;
    float* m_out;
    int m_blocks;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        V x[3 * C];
        HWY_UNROLL(12)
        for (int k = 0; k < 3 * C; ++k) x[k] = hn::Set(d, m_x[3 * firstColumn + k]);
        for (int b = 0; b < m_blocks; ++b, values += C * kPanelLanes)
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                float* out = m_out + b * kNodeLanes + h;
                V s0 = hn::Load(d, out), s1 = hn::Load(d, out + kPanelLanes), s2 = hn::Load(d, out + 2 * kPanelLanes);
                HWY_UNROLL(4)
                for (int c = 0; c < C; ++c)
                {
                    const V m = hn::Load(d, values + c * kPanelLanes + h);
                    s0 = hn::MulAdd(m, x[3 * c], s0);
                    s1 = hn::MulAdd(m, x[3 * c + 1], s1);
                    s2 = hn::MulAdd(m, x[3 * c + 2], s2);
                }
                hn::Store(s0, d, out);
                hn::Store(s1, d, out + kPanelLanes);
                hn::Store(s2, d, out + 2 * kPanelLanes);
            }
    }
};

/// out_c = (column c of the panel) . rows, one right-hand side.
struct IsotropicMultiplyTransposed
{
    const float* m_rows;
    float* m_out;
    int m_blocks;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        const D d;
        V sum[3 * C];
        HWY_UNROLL(12)
        for (int k = 0; k < 3 * C; ++k) sum[k] = hn::Zero(d);
        for (int b = 0; b < m_blocks; ++b, values += C * kPanelLanes)
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                const float* rows = m_rows + b * kNodeLanes + h;
                const V r0 = hn::Load(d, rows), r1 = hn::Load(d, rows + kPanelLanes),
                        r2 = hn::Load(d, rows + 2 * kPanelLanes);
                HWY_UNROLL(4)
                for (int c = 0; c < C; ++c)
                {
                    const V m = hn::Load(d, values + c * kPanelLanes + h);
                    sum[3 * c] = hn::MulAdd(m, r0, sum[3 * c]);
                    sum[3 * c + 1] = hn::MulAdd(m, r1, sum[3 * c + 1]);
                    sum[3 * c + 2] = hn::MulAdd(m, r2, sum[3 * c + 2]);
                }
            }
        HWY_UNROLL(12)
        for (int k = 0; k < 3 * C; ++k) m_out[3 * firstColumn + k] = sumOfLanes(sum[k]);
    }
};

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
    forEachChunk<1>(panel, IsotropicMultiply{y + 3 * static_cast<std::size_t>(panel.m_firstNode), scratch, blocks});
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
    forEachChunk<1>(panel, IsotropicMultiplyTransposed{scratch, own, panel.blocks()});
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
