// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/node_sums.h"

#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/node_sums.cpp"
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (BULLETFEM_DISABLED_TARGETS | HWY_AVX3)
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 4>;
constexpr int kN = static_cast<int>(hn::MaxLanes(D()));

HWY_INLINE hn::Vec<D> load(const double* corner)
{
    return hn::Load(D(), corner);
}

HWY_INLINE hn::Vec<D> load(const float* corner)
{
    return hn::PromoteTo(D(), hn::Load(hn::Rebind<float, D>(), corner));
}

/// Components from `first` on, as many as a vector has, of the sum over corners, in two alternating partial sums that
/// make additions independent.
template <class Real>
HWY_INLINE hn::Vec<D> sumOf(const Real* vectors, const int* corner, const int* end)
{
    hn::Vec<D> even = hn::Zero(D()), odd = hn::Zero(D());
    for (; corner + 1 < end; corner += 2)
    {
        even = hn::Add(even, load(vectors + 4 * static_cast<std::ptrdiff_t>(corner[0])));
        odd = hn::Add(odd, load(vectors + 4 * static_cast<std::ptrdiff_t>(corner[1])));
    }
    if (corner < end) even = hn::Add(even, load(vectors + 4 * static_cast<std::ptrdiff_t>(corner[0])));
    return hn::Add(even, odd);
}

template <class Real>
HWY_INLINE void sumOverNodes(const NodeSums<Real>& sums, Range nodes)
{
    const Real* vectors = &sums.m_corners->m_vector[0][0][0];
    const int* corner = sums.m_nodes->m_corner.data();
    const int* start = sums.m_nodes->m_start.data();
    for (int i = nodes.m_begin; i < nodes.m_end; ++i)
    {
        HWY_ALIGN double sum[4];
        for (int c = 0; c < 4; c += kN)
        {
            hn::Vec<D> s = sumOf(vectors + c, corner + start[i], corner + start[i + 1]);
            if (sums.m_scale) s = hn::MulAdd(hn::Set(D(), sums.m_scale[i]), hn::Load(D(), &sums.m_p[i].x + c), s);
            hn::Store(s, D(), sum + c);
        }
        const Vec3 total = {sum[0], sum[1], sum[2]};
        sums.m_out[i] = sums.m_scale ? total : sums.m_out[i] + total;
    }
}

BULLETFEM_KERNEL(sumOverNodes, NodeSums)

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT_KERNEL(sumOverNodes, NodeSums, sumCorners)

}  // namespace bullet_fem
#endif
