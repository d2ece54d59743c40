// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Transfer of elements' edges and corners between nodes and SIMD vectors. Included once for every instruction set.
#if defined(BULLETFEM_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_LANES_INL_H
#undef BULLETFEM_LANES_INL_H
#else
#define BULLETFEM_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <type_traits>

#include "fem/common/vectors-inl.h"
#include "fem/elements/element_blocks.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
/// D_s = [u_1 - u_0, u_2 - u_0, u_3 - u_0] of `Count` elements, transferred from nodes to vectors via memory, which is
/// faster than gathering components. Rows are laid out so that transposing blocks of 128 bits gives vectors. They are
/// written one iteration before they are read, to avoid store-forwarding stalls.
template <class Real, int Count = width<Real>()>
struct StagedEdges
{
    static constexpr int kBlock = 16 / sizeof(Real);  // entries in a block
    static constexpr int kRow = HWY_MAX(Count, kBlock);
    HWY_ALIGN Real m_rows[3][4 / kBlock][kBlock][kRow];

    HWY_INLINE void stage(const std::int32_t (*node)[4], const PaddedVec3* u)
    {
        for (int lane = 0; lane < Count; ++lane) stageLane(lane, node[lane], u);
    }

    HWY_INLINE void stageLane(int lane, const std::int32_t (&node)[4], const PaddedVec3* u)
    {
        const PaddedVec3& u0 = u[node[0]];
        HWY_UNROLL(3)
        for (int a = 0; a < 3; ++a) storeDifference(u[node[a + 1]], u0, a, lane);
    }

    /// The edges of the elements from `lane` on.
    HWY_INLINE Matrix<Real> load(int lane = 0) const
    {
        Matrix<Real> D;
        HWY_UNROLL(3)
        for (int a = 0; a < 3; ++a) transposeRows(m_rows[a], lane, D.m[0][a], D.m[1][a], D.m[2][a]);
        return D;
    }

private:
    /// Destination of part of an element's edge: entries from `component` on, at most those of a block.
    HWY_INLINE Real* place(int a, int lane, int component)
    {
        return m_rows[a][component / kBlock][lane % kBlock] + lane / kBlock * kBlock + component % kBlock;
    }

    /// Edge a is to - from, computed in double.
    HWY_INLINE void storeDifference(const PaddedVec3& to, const PaddedVec3& from, int a, int lane)
    {
        const hn::CappedTag<double, 4> d;
        for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d)))
        {
            const auto edge = hn::Sub(hn::Load(d, &to.x + i), hn::Load(d, &from.x + i));
            storeRounded(d, edge, a, lane, i);
        }
    }

    template <class D>
    HWY_INLINE void storeRounded(D d, hn::Vec<D> edge, int a, int lane, int i)
    {
        if constexpr (std::is_same<Real, float>::value)
        {
            const hn::Rebind<float, D> single;
            hn::Store(hn::DemoteTo(single, edge), single, place(a, lane, i));
        }
#if HWY_TARGET != HWY_SCALAR
        else if constexpr (hn::MaxLanes(D()) == 4)
        {
            const hn::Half<D> half;
            hn::Store(hn::LowerHalf(half, edge), half, place(a, lane, 0));
            hn::Store(hn::UpperHalf(half, edge), half, place(a, lane, 2));
        }
#endif
        else
            hn::Store(edge, d, place(a, lane, i));
    }

#if HWY_TARGET == HWY_SCALAR
    HWY_INLINE static void transposeRows(const Real (&rows)[4 / kBlock][kBlock][kRow], int, Vector<Real>& x,
                                         Vector<Real>& y, Vector<Real>& z)
    {
        const Lanes<Real> d;
        x = hn::Load(d, &rows[0][0][0]);
        y = hn::Load(d, &rows[0][0][1]);
        z = hn::Load(d, &rows[2 / kBlock][0][2 % kBlock]);
    }
#else
    HWY_INLINE static void transposeRows(const float (&rows)[1][4][kRow], int lane, Vector<float>& x, Vector<float>& y,
                                         Vector<float>& z)
    {
        const Lanes<float> d;
        const hn::Repartition<double, Lanes<float> > pairs;
        const auto r0 = hn::Load(d, rows[0][0] + lane), r1 = hn::Load(d, rows[0][1] + lane);
        const auto r2 = hn::Load(d, rows[0][2] + lane), r3 = hn::Load(d, rows[0][3] + lane);
        const auto xy01 = hn::BitCast(pairs, hn::InterleaveLower(d, r0, r1));
        const auto xy23 = hn::BitCast(pairs, hn::InterleaveLower(d, r2, r3));
        const auto z01 = hn::BitCast(pairs, hn::InterleaveUpper(d, r0, r1));
        const auto z23 = hn::BitCast(pairs, hn::InterleaveUpper(d, r2, r3));
        // x0 x1 y0 y1 with x2 x3 y2 y3
        x = hn::BitCast(d, hn::InterleaveLower(pairs, xy01, xy23));
        y = hn::BitCast(d, hn::InterleaveUpper(pairs, xy01, xy23));
        z = hn::BitCast(d, hn::InterleaveLower(pairs, z01, z23));
    }

    HWY_INLINE static void transposeRows(const double (&rows)[2][2][kRow], int lane, Vector<double>& x,
                                         Vector<double>& y, Vector<double>& z)
    {
        const Lanes<double> d;
        const auto xy0 = hn::Load(d, rows[0][0] + lane), xy1 = hn::Load(d, rows[0][1] + lane);
        x = hn::InterleaveLower(d, xy0, xy1);
        y = hn::InterleaveUpper(d, xy0, xy1);
        z = hn::InterleaveLower(d, hn::Load(d, rows[1][0] + lane), hn::Load(d, rows[1][1] + lane));
    }
#endif
};

/// Calls stage(block, lane, slot) and then compute(block, lane, slot) for every vector of elements of the blocks; each
/// vector is staged before its predecessor is computed. Slots alternate between 0 and 1.
template <class Real, class Stage, class Compute>
HWY_INLINE void forEachVector(Range blocks, const Stage& stage, const Compute& compute)
{
    constexpr int kVectors = kLanes / width<Real>();  // vectors in a block
    const int end = blocks.m_end * kVectors;
    int k = blocks.m_begin * kVectors;
    if (k < end) stage(k / kVectors, k % kVectors * width<Real>(), k % 2);
    for (; k < end; ++k)
    {
        const int next = k + 1;
        if (next < end) stage(next / kVectors, next % kVectors * width<Real>(), next % 2);
        compute(k / kVectors, k % kVectors * width<Real>(), k % 2);
    }
}

/// Elements of as many patches as a vector has lanes: from `m_lane` on in each of `m_size` blocks of a group.
struct PatchColumn
{
    int m_block, m_lane, m_size, m_group;
};

/// The column of an index; columns are numbered group by group.
template <class Real>
HWY_INLINE PatchColumn patchColumn(const std::vector<PatchGroup>& groups, int column)
{
    constexpr int kVectors = kLanes / width<Real>();  // vectors in a block
    const PatchGroup& group = groups[column / kVectors];
    return {group.m_firstBlock, column % kVectors * width<Real>(), group.m_blocks, column / kVectors};
}

/// Calls stage(column, k, slot) for every element k of every column of the groups, and then compute(column, slot,
/// other), during which other(k) stages element k of the next column, if there is one. Slots alternate between 0 and 1.
template <class Real, class Stage, class Compute>
HWY_INLINE void forEachColumn(const std::vector<PatchGroup>& groups, Range range, const Stage& stage,
                              const Compute& compute)
{
    constexpr int kVectors = kLanes / width<Real>();  // vectors in a block
    const int end = range.m_end * kVectors;
    const auto column = [&groups](int c) { return patchColumn<Real>(groups, c); };
    int c = range.m_begin * kVectors;
    if (c >= end) return;
    PatchColumn now = column(c);
    for (int k = 0; k < now.m_size; ++k) stage(now, k, c % 2);
    for (; c < end; ++c)
    {
        const PatchColumn next = c + 1 < end ? column(c + 1) : PatchColumn{0, 0, 0, 0};
        const auto other = [&](int k)
        {
            if (k < next.m_size) stage(next, k, (c + 1) % 2);
        };
        compute(now, c % 2, other);
        for (int k = now.m_size; k < next.m_size; ++k) other(k);
        now = next;
    }
}

/// Stores f_1, f_2, f_3, the columns of f, and f_0 = -(f_1 + f_2 + f_3) as the corners of the elements from `lane` on.
template <class Real>
HWY_INLINE void storeCorners(const Matrix<Real>& f, CornerBlock<Real>& out, int lane)
{
    const Lanes<Real> d;
    const Vector<Real> zero = hn::Zero(d);
    Vector<Real> f0[3];
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) f0[i] = hn::Sub(zero, hn::Add(hn::Add(f.m[i][0], f.m[i][1]), f.m[i][2]));
    hn::StoreInterleaved4(f0[0], f0[1], f0[2], zero, d, out.m_vector[0][lane]);
    HWY_UNROLL(3)
    for (int a = 0; a < 3; ++a)
        hn::StoreInterleaved4(f.m[0][a], f.m[1][a], f.m[2][a], zero, d, out.m_vector[a + 1][lane]);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
