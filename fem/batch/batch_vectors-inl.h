// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Three-dimensional vectors of bodies side by side, bitwise equal to the operators of Vec3. Included once for every
// instruction set.
#if defined(BULLETFEM_LANE_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_LANE_VECTORS_INL_H
#undef BULLETFEM_LANE_VECTORS_INL_H
#else
#define BULLETFEM_LANE_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "fem/body/batch_width.h"
#include "fem/common/chunks.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kBatchWidth>;
using V = hn::Vec<D>;
constexpr int kN = static_cast<int>(hn::MaxLanes(D()));  // bodies in a vector

struct V3
{
    V x, y, z;
};

HWY_INLINE V3 operator+(const V3& a, const V3& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE V3 operator-(const V3& a, const V3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE V3 operator*(const V3& a, V s)
{
    return {a.x * s, a.y * s, a.z * s};
}
HWY_INLINE V dot(const V3& a, const V3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE V3 cross(const V3& a, const V3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Offset of a node's vector in [node][3][body], and of its mass in [node][body], from body `lane` on.
HWY_INLINE std::size_t place(int node, int lane)
{
    return static_cast<std::size_t>(node) * 3 * kBatchWidth + lane;
}
HWY_INLINE std::size_t massPlace(int node, int lane)
{
    return static_cast<std::size_t>(node) * kBatchWidth + lane;
}

HWY_INLINE V loadOne(const double* from)
{
    return hn::Load(D(), from);
}
HWY_INLINE V3 load3(const double* from)
{
    return {loadOne(from), loadOne(from + kBatchWidth), loadOne(from + 2 * kBatchWidth)};
}
HWY_INLINE void store3(const V3& v, double* to)
{
    hn::Store(v.x, D(), to);
    hn::Store(v.y, D(), to + kBatchWidth);
    hn::Store(v.z, D(), to + 2 * kBatchWidth);
}

/// Per-body values, which need not be aligned.
HWY_INLINE V valuesOf(const PerBatch& values, int lane)
{
    return hn::LoadU(D(), values.m + lane);
}
HWY_INLINE void storeValues(V v, int lane, PerBatch& to)
{
    hn::StoreU(v, D(), to.m + lane);
}

/// Returns the sum of a node's corner contributions (its two partial sums) and resets both to zero.
HWY_INLINE V3 takeSum(double* sums, int node, int lane)
{
    double *even = sums + place(2 * node, lane), *odd = sums + place(2 * node + 1, lane);
    const V3 sum = load3(even) + load3(odd);
    const V zero = hn::Zero(D());
    store3({zero, zero, zero}, even);
    store3({zero, zero, zero}, odd);
    return sum;
}

/// Calls visit(node, lane) for every node and vector of bodies.
template <class Visit>
HWY_INLINE void forEachNode(int nodes, const Visit& visit)
{
    for (int node = 0; node < nodes; ++node)
        for (int lane = 0; lane < kBatchWidth; lane += kN) visit(node, lane);
}

/// A node's contributions to several sums of every body.
template <int kSums>
struct Terms
{
    V m_term[kSums];

    HWY_INLINE void add(const Terms& other)
    {
        HWY_UNROLL(4)
        for (int s = 0; s < kSums; ++s) m_term[s] = m_term[s] + other.m_term[s];
    }
};

/// Sums terms(node, lane), which returns a Terms and may have side effects: it is called once per node and lane. The
/// summation order is that of the single body's dot(): in chunks, with four partial sums in each, so that additions are
/// independent.
template <int kSums, class TermsOf>
HWY_INLINE void sumsOverNodes(int nodes, PerBatch* const (&out)[kSums], const TermsOf& terms)
{
    Terms<kSums> zero{};  // braces avoid a constructor compiled without the instruction set
    for (V& term : zero.m_term) term = hn::Zero(D());
    const Chunks pieces(nodes, kEntriesPerChunk);
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        Terms<kSums> total = zero;
        for (int p = 0; p < pieces.count(); ++p)
        {
            Terms<kSums> sum[4] = {zero, zero, zero, zero};
            int i = pieces[p].m_begin;
            for (; i + 4 <= pieces[p].m_end; i += 4)
            {
                HWY_UNROLL(4)
                for (int k = 0; k < 4; ++k) sum[k].add(terms(i + k, lane));
            }
            for (; i < pieces[p].m_end; ++i) sum[0].add(terms(i, lane));
            sum[0].add(sum[1]);
            sum[2].add(sum[3]);
            sum[0].add(sum[2]);
            total.add(sum[0]);
        }
        for (int s = 0; s < kSums; ++s) storeValues(total.m_term[s], lane, *out[s]);
    }
}

/// One such sum: in chunks, with four partial sums in each.
template <class Term>
HWY_INLINE PerBatch sumOverNodes(int nodes, const Term& term)
{
    PerBatch out;
    sumsOverNodes<1>(nodes, {&out}, [&](int node, int lane) { return Terms<1>{{term(node, lane)}}; });
    return out;
}

/// Calls visit(at, lane) for every vector of values of [node][3][body].
template <class Visit>
HWY_INLINE void forEachNumber(int nodes, const Visit& visit)
{
    const std::size_t size = place(nodes, 0);
    for (std::size_t at = 0; at < size; at += kBatchWidth)
        for (int lane = 0; lane < kBatchWidth; lane += kN) visit(at + lane, lane);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
