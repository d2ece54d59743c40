// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/factor/lane_gradients.h"

#include <algorithm>
#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/factor/lane_vectors.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/factor/panel_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

constexpr int kNodesOfSum = 16;  // nodes summed in single precision before the sum continues in double

struct alignas(64) SingleNumbers
{
    SingleNumbers() = default;
    explicit SingleNumbers(const LaneNumbers& numbers)
    {
        for (int k = 0; k < kPanelLanes; ++k) m[k] = static_cast<float>(numbers.m[k]);
    }

    float m[kPanelLanes] = {};
};

/// Adds the single-precision sums to the double ones, and resets them.
HWY_INLINE void moveSums(SingleNumbers& from, LaneNumbers& to)
{
    for (int k = 0; k < kPanelLanes; ++k)
    {
        to.m[k] += from.m[k];
        from.m[k] = 0;
    }
}

/// sum += a . b over a node's three directions.
HWY_INLINE V dot3(V sum, const V* a, const V* b)
{
    return hn::MulAdd(a[2], b[2], hn::MulAdd(a[1], b[1], hn::MulAdd(a[0], b[0], sum)));
}

HWY_INLINE void load3(const float* from, V* v)
{
    const D d;
    for (int i = 0; i < 3; ++i) v[i] = hn::Load(d, from + i * kPanelLanes);
}

HWY_INLINE void store3(const V* v, float* to)
{
    const D d;
    for (int i = 0; i < 3; ++i) hn::Store(v[i], d, to + i * kPanelLanes);
}

/// y += B x, or y += B^T x.
template <bool Transposed>
HWY_INLINE void addBlock(const float* B, const V* x, V* y)
{
    const D d;
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) y[i] = hn::MulAdd(hn::Set(d, B[Transposed ? 3 * j + i : 3 * i + j]), x[j], y[i]);
}

void TurnLanes(const LaneVectors& v, const LaneNumbers& beta)
{
    const D d;
    const SingleNumbers b(beta);
    const std::size_t size = static_cast<std::size_t>(v.m_nodes) * kNodeLanes;
    for (std::size_t i = 0; i < size; i += kPanelLanes)
        for (int h = 0; h < kPanelLanes; h += kN)
        {
            const V q = hn::Load(d, v.m_q + i + h), p = hn::Load(d, v.m_p + i + h);
            hn::Store(hn::MulAdd(hn::Load(d, b.m + h), p, q), d, v.m_p + i + h);
            hn::Store(hn::Zero(d), d, v.m_q + i + h);
        }
}

void AdvanceLanes(const LaneVectors& v, const LaneNumbers& step)
{
    const D d;
    const SingleNumbers s(step);
    const std::size_t size = static_cast<std::size_t>(v.m_nodes) * kNodeLanes;
    for (std::size_t i = 0; i < size; i += kPanelLanes)
        for (int h = 0; h < kPanelLanes; h += kN)
        {
            const std::size_t at = i + h;
            const V a = hn::Load(d, s.m + h);
            hn::Store(hn::MulAdd(a, hn::Load(d, v.m_p + at), hn::Load(d, v.m_x + at)), d, v.m_x + at);
            const V r = hn::NegMulAdd(a, hn::Load(d, v.m_q + at), hn::Load(d, v.m_r + at));
            hn::Store(r, d, v.m_r + at);
            hn::Store(r, d, v.m_q + at);
        }
}

LaneNumbers DotLanes(const LaneVectors& v)
{
    LaneNumbers sum;
    const D d;
    SingleNumbers part;
    for (int i = 0; i < v.m_nodes; ++i)
    {
        for (int h = 0; h < kPanelLanes; h += kN)
        {
            const std::size_t at = static_cast<std::size_t>(i) * kNodeLanes + h;
            V r[3], q[3];
            load3(v.m_r + at, r);
            load3(v.m_q + at, q);
            hn::Store(dot3(hn::Load(d, part.m + h), r, q), d, part.m + h);
        }
        if (i % kNodesOfSum == kNodesOfSum - 1) moveSums(part, sum);
    }
    moveSums(part, sum);
    return sum;
}

/// Multiplies a row of the lower half, and its transpose. Rows are processed from the last one on, so that q_i has all
/// contributions of later rows when row i is finished.
HWY_INLINE V multiplyRow(const RestMatrix& A, int row, const LaneVectors& v, std::size_t h, V sum)
{
    const std::size_t at = static_cast<std::size_t>(row) * kNodeLanes + h;
    V p[3], q[3];
    load3(v.m_p + at, p);
    load3(v.m_q + at, q);
    const int diagonal = A.m_rowStart[row + 1] - 1;
    const float* B = A.m_values.data() + 9 * static_cast<std::size_t>(A.m_rowStart[row]);
    for (int k = A.m_rowStart[row]; k < diagonal; ++k, B += 9)
    {
        const std::size_t other = static_cast<std::size_t>(A.m_column[k]) * kNodeLanes + h;
        V pk[3], qk[3];
        load3(v.m_p + other, pk);
        load3(v.m_q + other, qk);
        addBlock<false>(B, pk, q);
        addBlock<true>(B, p, qk);
        store3(qk, v.m_q + other);
    }
    addBlock<false>(B, p, q);
    store3(q, v.m_q + at);
    return dot3(sum, p, q);
}

LaneNumbers MultiplyRows(const RestMatrix& A, const LaneVectors& v)
{
    LaneNumbers sum;
    const D d;
    SingleNumbers part;
    for (int i = v.m_nodes - 1; i >= 0; --i)
    {
        for (int h = 0; h < kPanelLanes; h += kN)
            hn::Store(multiplyRow(A, i, v, h, hn::Load(d, part.m + h)), d, part.m + h);
        if (i % kNodesOfSum == 0) moveSums(part, sum);
    }
    return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(TurnLanes, void turnLanes(const LaneVectors& v, const LaneNumbers& beta), v, beta)
BULLETFEM_EXPORT(AdvanceLanes, void advanceLanes(const LaneVectors& v, const LaneNumbers& step), v, step)
BULLETFEM_EXPORT(DotLanes, LaneNumbers dotLanes(const LaneVectors& v), v)
BULLETFEM_EXPORT(MultiplyRows, LaneNumbers multiplyLanes(const RestMatrix& A, const LaneVectors& v), A, v)

}  // namespace bullet_fem
#endif
