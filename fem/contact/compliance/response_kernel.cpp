// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/contact/compliance/response_kernel.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/contact/compliance/response_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, kResponsePadding>;
using Vector = hn::Vec<Lanes>;

// kCount responses in one pass over the velocities.
template <int kCount>
HWY_INLINE void addSome(const Response* in, std::size_t order, double* velocity)
{
    const Lanes d;
    const hn::Rebind<float, Lanes> half;
    Vector impulse[3 * kCount];
    const float* column[3 * kCount];
    for (int k = 0; k < kCount; ++k)
        for (int c = 0; c < 3; ++c)
        {
            impulse[3 * k + c] = hn::Set(d, in[k].m_impulse[c]);
            column[3 * k + c] = in[k].m_columns + c * in[k].m_stride;
        }
    for (std::size_t i = 0; i < order; i += hn::Lanes(d))
    {
        auto v = hn::LoadU(d, velocity + i);
        for (int k = 0; k < 3 * kCount; ++k)
            v = hn::MulAdd(hn::PromoteTo(d, hn::LoadU(half, column[k] + i)), impulse[k], v);
        hn::StoreU(v, d, velocity + i);
    }
}

void AddResponses(const Response* responses, std::size_t count, std::size_t order, double* velocity)
{
    std::size_t k = 0;
    for (; k + 4 <= count; k += 4) addSome<4>(responses + k, order, velocity);
    switch (count - k)
    {
        case 3:
            return addSome<3>(responses + k, order, velocity);
        case 2:
            return addSome<2>(responses + k, order, velocity);
        case 1:
            return addSome<1>(responses + k, order, velocity);
        default:
            return;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(AddResponses);

void addResponses(const Response* responses, std::size_t count, std::size_t order, double* velocity)
{
    HWY_DYNAMIC_DISPATCH(AddResponses)(responses, count, order, velocity);
}

void scalar::addResponses(const Response* responses, std::size_t count, std::size_t order, double* velocity)
{
    for (const Response* r = responses; r != responses + count; ++r)
        for (std::size_t i = 0; i < order; ++i)
            for (int c = 0; c < 3; ++c) velocity[i] += r->m_columns[c * r->m_stride + i] * r->m_impulse[c];
}

}  // namespace bullet_fem
#endif
