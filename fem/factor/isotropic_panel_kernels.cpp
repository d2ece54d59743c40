// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time. One entry of a panel serves three directions, so these
// kernels are limited by arithmetic where those with three rows a node are limited by memory.
#include "fem/factor/isotropic_panel_kernels.h"

#include <algorithm>
#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/factor/isotropic_panel_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/factor/panel_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

constexpr int kLanes = kNodeLanes;  // floats of 16 nodes in the scratch of one right-hand side

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
                float* out = m_out + b * kLanes + h;
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
                const float* rows = m_rows + b * kLanes + h;
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
    return static_cast<std::size_t>(r / kPanelLanes) * kLanes + r % kPanelLanes;
}

void ForwardIsotropic(const Panel& panel, float* y, float* scratch)
{
    const D d;
    const int blocks = panel.blocksBelow();
    for (int i = 0; i < blocks * kLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + i);
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
    const int last = (panel.blocks() - 1) * kLanes;  // only the last block has padding
    for (int i = 0; i < kLanes; i += kN) hn::Store(hn::Zero(d), d, scratch + last + i);
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

HWY_EXPORT(ForwardIsotropic);
HWY_EXPORT(BackwardIsotropic);
HWY_EXPORT(ForwardIsotropicLanes);
HWY_EXPORT(BackwardIsotropicLanes);

void forwardIsotropic(const Panel& panel, float* y, float* scratch)
{
    HWY_DYNAMIC_DISPATCH(ForwardIsotropic)(panel, y, scratch);
}

void backwardIsotropic(const Panel& panel, float* y, float* scratch)
{
    HWY_DYNAMIC_DISPATCH(BackwardIsotropic)(panel, y, scratch);
}

void forwardIsotropicLanes(const Panel& panel, float* y, float* scratch)
{
    HWY_DYNAMIC_DISPATCH(ForwardIsotropicLanes)(panel, y, scratch);
}

void backwardIsotropicLanes(const Panel& panel, float* y, float* scratch)
{
    HWY_DYNAMIC_DISPATCH(BackwardIsotropicLanes)(panel, y, scratch);
}

}  // namespace bullet_fem
#endif
