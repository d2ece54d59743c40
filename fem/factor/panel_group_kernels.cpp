// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs. Every sum is taken in the order
// of panel_kernels.cpp: along a row of M column by column; along a column of the panel one sum a lane, row by row.
#include "fem/factor/panel_group_kernels.h"

#include <algorithm>
#include <cstddef>

#include "fem/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/factor/panel_group_kernels.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/factor/panel_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

// Columns of a chunk that are worked on at a time: for each there is a register a vector of the group.
constexpr int kColumns = HWY_CAP_GE512 ? 6 : 3;

/// Calls run(number of columns as a constant, the first of them) for the columns of a chunk of C.
template <int C, int First = 0, class Run>
HWY_INLINE void forColumns(const Run& run)
{
    if constexpr (First < C)
    {
        constexpr int kCount = C - First < kColumns ? C - First : kColumns;
        run(std::integral_constant<int, kCount>(), std::integral_constant<int, First>());
        forColumns<C, First + kCount>(run);
    }
}

/// out += (rows of M) x, K right-hand sides.
template <int K>
struct MultiplyGroup
{
    const float* m_x[K];
    float* m_out[K];
    int m_blocks;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        forColumns<C>([&](auto count, auto first)
                      { multiply<count.value, C>(firstColumn + first.value, values + first.value * kPanelLanes); });
    }

    template <int N, int C>
    HWY_INLINE void multiply(int firstColumn, const float* values) const
    {
        const D d;
        V x[K][N];
        HWY_UNROLL(4)
        for (int k = 0; k < K; ++k)
        {
            HWY_UNROLL(6)
            for (int c = 0; c < N; ++c) x[k][c] = hn::Set(d, m_x[k][firstColumn + c]);
        }
        for (int b = 0; b < m_blocks; ++b, values += C * kPanelLanes)
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                const int row = b * kPanelLanes + h;
                V sum[K];
                HWY_UNROLL(4)
                for (int k = 0; k < K; ++k) sum[k] = hn::Load(d, m_out[k] + row);
                HWY_UNROLL(6)
                for (int c = 0; c < N; ++c)
                {
                    const V entries = hn::Load(d, values + c * kPanelLanes + h);
                    HWY_UNROLL(4)
                    for (int k = 0; k < K; ++k) sum[k] = hn::MulAdd(entries, x[k][c], sum[k]);
                }
                HWY_UNROLL(4)
                for (int k = 0; k < K; ++k) hn::Store(sum[k], d, m_out[k] + row);
            }
    }
};

/// out_c = (column c of the panel) . rows, K right-hand sides.
template <int K>
struct MultiplyTransposedGroup
{
    const float* m_rows[K];
    float* m_out[K];
    int m_blocks;

    template <int C>
    HWY_INLINE void operator()(std::integral_constant<int, C>, int firstColumn, const float* values) const
    {
        forColumns<C>([&](auto count, auto first)
                      { multiply<count.value, C>(firstColumn + first.value, values + first.value * kPanelLanes); });
    }

    template <int N, int C>
    HWY_INLINE void multiply(int firstColumn, const float* values) const
    {
        const D d;
        V sum[K][N];
        HWY_UNROLL(4)
        for (int k = 0; k < K; ++k)
        {
            HWY_UNROLL(6)
            for (int c = 0; c < N; ++c) sum[k][c] = hn::Zero(d);
        }
        for (int b = 0; b < m_blocks; ++b, values += C * kPanelLanes)
            for (int h = 0; h < kPanelLanes; h += kN)
            {
                V row[K];
                HWY_UNROLL(4)
                for (int k = 0; k < K; ++k) row[k] = hn::Load(d, m_rows[k] + b * kPanelLanes + h);
                HWY_UNROLL(6)
                for (int c = 0; c < N; ++c)
                {
                    const V entries = hn::Load(d, values + c * kPanelLanes + h);
                    HWY_UNROLL(4)
                    for (int k = 0; k < K; ++k) sum[k][c] = hn::MulAdd(entries, row[k], sum[k][c]);
                }
            }
        HWY_UNROLL(4)
        for (int k = 0; k < K; ++k)
        {
            HWY_UNROLL(6)
            for (int c = 0; c < N; ++c) m_out[k][firstColumn + c] = hn::GetLane(hn::SumOfLanes(d, sum[k][c]));
        }
    }
};

template <int K>
HWY_INLINE void forwardGroup(const Panel& panel, const PanelGroup& group)
{
    const D d;
    MultiplyGroup<K> multiply;
    multiply.m_blocks = panel.blocksBelow();
    for (int k = 0; k < K; ++k)
    {
        multiply.m_x[k] = group.m_y[k] + 3 * static_cast<std::size_t>(panel.m_firstNode);
        multiply.m_out[k] = group.m_scratch[k];
        for (int i = 0; i < multiply.m_blocks * kPanelLanes; i += kN) hn::Store(hn::Zero(d), d, multiply.m_out[k] + i);
    }
    forEachChunk<3>(panel, multiply);
    for (int r = 0; r < panel.m_rowsBelow; r += 3)
    {
        const std::size_t row = 3 * static_cast<std::size_t>(panel.m_row[r / 3]);
        for (int k = 0; k < K; ++k)
            for (int i = 0; i < 3; ++i) group.m_y[k][row + i] -= group.m_scratch[k][r + i];
    }
}

template <int K>
HWY_INLINE void backwardGroup(const Panel& panel, const PanelGroup& group)
{
    MultiplyTransposedGroup<K> multiply;
    multiply.m_blocks = panel.blocks();
    for (int k = 0; k < K; ++k)
    {
        multiply.m_rows[k] = group.m_scratch[k];
        multiply.m_out[k] = group.m_y[k] + 3 * static_cast<std::size_t>(panel.m_firstNode);
    }
    for (int r = 0; r < panel.m_rowsBelow; r += 3)
    {
        const std::size_t row = 3 * static_cast<std::size_t>(panel.m_row[r / 3]);
        for (int k = 0; k < K; ++k)
            for (int i = 0; i < 3; ++i) group.m_scratch[k][r + i] = -group.m_y[k][row + i];
    }
    for (int k = 0; k < K; ++k)
    {
        const float* own = multiply.m_out[k];
        float* rows = std::copy(own, own + panel.m_columns, group.m_scratch[k] + panel.m_rowsBelow);
        std::fill(rows, group.m_scratch[k] + panel.blocks() * kPanelLanes, 0.f);
    }
    forEachChunk<3>(panel, multiply);
}

void ForwardPanelGroup(const Panel& panel, const PanelGroup& group)
{
    switch (group.m_count)
    {
        case 1:
            return forwardGroup<1>(panel, group);
        case 2:
            return forwardGroup<2>(panel, group);
        case 3:
            return forwardGroup<3>(panel, group);
        default:
            return forwardGroup<4>(panel, group);
    }
}

void BackwardPanelGroup(const Panel& panel, const PanelGroup& group)
{
    switch (group.m_count)
    {
        case 1:
            return backwardGroup<1>(panel, group);
        case 2:
            return backwardGroup<2>(panel, group);
        case 3:
            return backwardGroup<3>(panel, group);
        default:
            return backwardGroup<4>(panel, group);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(ForwardPanelGroup);
HWY_EXPORT(BackwardPanelGroup);

void forwardPanelGroup(const Panel& panel, const PanelGroup& group)
{
    HWY_DYNAMIC_DISPATCH(ForwardPanelGroup)(panel, group);
}

void backwardPanelGroup(const Panel& panel, const PanelGroup& group)
{
    HWY_DYNAMIC_DISPATCH(BackwardPanelGroup)(panel, group);
}

}  // namespace bullet_fem
#endif
