// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/contact/response_kernel.h"

#include "fem/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/contact/response_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

void AddResponse(const float* columns, std::size_t order, const Vec3& impulse, double* velocity)
{
    const hn::ScalableTag<double> d;
    const hn::Rebind<float, hn::ScalableTag<double>> half;
    const std::size_t lanes = hn::Lanes(d);
    const float *w0 = columns, *w1 = w0 + order, *w2 = w1 + order;
    const auto x = hn::Set(d, impulse.x), y = hn::Set(d, impulse.y), z = hn::Set(d, impulse.z);
    std::size_t i = 0;
    for (; i + lanes <= order; i += lanes)
    {
        auto v = hn::LoadU(d, velocity + i);
        v = hn::MulAdd(hn::PromoteTo(d, hn::LoadU(half, w0 + i)), x, v);
        v = hn::MulAdd(hn::PromoteTo(d, hn::LoadU(half, w1 + i)), y, v);
        v = hn::MulAdd(hn::PromoteTo(d, hn::LoadU(half, w2 + i)), z, v);
        hn::StoreU(v, d, velocity + i);
    }
    for (; i < order; ++i) velocity[i] += w0[i] * impulse.x + w1[i] * impulse.y + w2[i] * impulse.z;
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(AddResponse);

void addResponse(const float* columns, std::size_t order, const Vec3& impulse, double* velocity)
{
    HWY_DYNAMIC_DISPATCH(AddResponse)(columns, order, impulse, velocity);
}

void scalar::addResponse(const float* columns, std::size_t order, const Vec3& impulse, double* velocity)
{
    for (std::size_t i = 0; i < order; ++i)
        velocity[i] += columns[i] * impulse.x + columns[order + i] * impulse.y + columns[2 * order + i] * impulse.z;
}

}  // namespace bullet_fem
#endif
