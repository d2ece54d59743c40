// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/contact/compliance/row_products.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/contact/compliance/row_products.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

// Nine sums at once: six loads for nine products.
void SubtractRowProducts(const RowTriple& a, const RowTriple& b, std::size_t count, double* block)
{
    const hn::CappedTag<double, 4> d;  // wider ones would leave long remainders
    using Vector = hn::Vec<decltype(d)>;
    const double *a0 = a.m_first, *a1 = a0 + a.m_stride, *a2 = a1 + a.m_stride;
    const double *b0 = b.m_first, *b1 = b0 + b.m_stride, *b2 = b1 + b.m_stride;
    Vector s00 = hn::Zero(d), s01 = s00, s02 = s00, s10 = s00, s11 = s00, s12 = s00, s20 = s00, s21 = s00, s22 = s00;
    std::size_t k = 0;
    for (; k + hn::Lanes(d) <= count; k += hn::Lanes(d))
    {
        const Vector y0 = hn::LoadU(d, b0 + k), y1 = hn::LoadU(d, b1 + k), y2 = hn::LoadU(d, b2 + k);
        const Vector x0 = hn::LoadU(d, a0 + k);
        s00 = hn::MulAdd(x0, y0, s00);
        s01 = hn::MulAdd(x0, y1, s01);
        s02 = hn::MulAdd(x0, y2, s02);
        const Vector x1 = hn::LoadU(d, a1 + k);
        s10 = hn::MulAdd(x1, y0, s10);
        s11 = hn::MulAdd(x1, y1, s11);
        s12 = hn::MulAdd(x1, y2, s12);
        const Vector x2 = hn::LoadU(d, a2 + k);
        s20 = hn::MulAdd(x2, y0, s20);
        s21 = hn::MulAdd(x2, y1, s21);
        s22 = hn::MulAdd(x2, y2, s22);
    }
    const auto sum = [&d](Vector v) { return hn::GetLane(hn::SumOfLanes(d, v)); };
    const double sums[9] = {sum(s00), sum(s01), sum(s02), sum(s10), sum(s11), sum(s12), sum(s20), sum(s21), sum(s22)};
    for (int e = 0; e < 9; ++e) block[e] -= sums[e];
    scalar::subtractRowProducts({a0 + k, a.m_stride}, {b0 + k, b.m_stride}, count - k, block);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(SubtractRowProducts);

void subtractRowProducts(const RowTriple& a, const RowTriple& b, std::size_t count, double* block)
{
    HWY_DYNAMIC_DISPATCH(SubtractRowProducts)(a, b, count, block);
}

void scalar::subtractRowProducts(const RowTriple& a, const RowTriple& b, std::size_t count, double* block)
{
    for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d)
            for (std::size_t k = 0; k < count; ++k)
                block[3 * c + d] -= a.m_first[c * a.m_stride + k] * b.m_first[d * b.m_stride + k];
}

}  // namespace bullet_fem
#endif
