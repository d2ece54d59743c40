// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/contact/compliance/compliance_kernel.h"

#include <algorithm>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/contact/compliance/compliance_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, kColumnOfRotation>;
using Vector = hn::Vec<Lanes>;

#if HWY_TARGET == HWY_SCALAR  // has no vectors of four
void TurnColumn(const RestColumn& in, float* columns)
{
    scalar::turnColumn(in, columns);
}
#else
// Columns of three values are read and written as four: the value after a column of the result is overwritten next, or,
// at the end, preserved.
void TurnColumn(const RestColumn& in, float* columns)
{
    const Lanes d;
    Vector source[9];
    for (int k = 0; k < 9; ++k) source[k] = hn::Set(d, in.m_source[k]);
    for (std::size_t i = in.m_first; i < in.m_end; ++i)
    {
        const float* block = in.m_blocks + in.m_offsets[i];
        const float* rotation = in.m_rotations + 3 * kColumnOfRotation * i;
        Vector turned[3];  // columns of R_i (A0^-1)_ij
        for (int n = 0; n < 3; ++n) turned[n] = hn::Mul(hn::LoadU(d, rotation), hn::Set(d, block[n]));
        for (int m = 1; m < 3; ++m)
            for (int n = 0; n < 3; ++n)
                turned[n] =
                    hn::MulAdd(hn::LoadU(d, rotation + kColumnOfRotation * m), hn::Set(d, block[3 * m + n]), turned[n]);
        for (int c = 0; c < 3; ++c)
        {
            const Vector column =
                hn::MulAdd(turned[2], source[3 * c + 2],
                           hn::MulAdd(turned[1], source[3 * c + 1], hn::Mul(turned[0], source[3 * c])));
            float* out = columns + c * in.m_stride + 3 * i;
            if (i + 1 < in.m_end)
                hn::StoreU(column, d, out);
            else
            {
                HWY_ALIGN float last[kColumnOfRotation];
                hn::Store(column, d, last);
                std::copy_n(last, 3, out);
            }
        }
    }
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(TurnColumn);

void turnColumn(const RestColumn& column, float* columns)
{
    HWY_DYNAMIC_DISPATCH(TurnColumn)(column, columns);
}

void scalar::turnColumn(const RestColumn& in, float* columns)
{
    for (std::size_t i = in.m_first; i < in.m_end; ++i)
    {
        const float* block = in.m_blocks + in.m_offsets[i];
        const float* rotation = in.m_rotations + 3 * kColumnOfRotation * i;
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < 3; ++k)
            {
                float sum = 0;
                for (int m = 0; m < 3; ++m)
                    for (int n = 0; n < 3; ++n)
                        sum += rotation[kColumnOfRotation * m + k] * block[3 * m + n] * in.m_source[3 * c + n];
                columns[c * in.m_stride + 3 * i + k] = sum;
            }
    }
}

}  // namespace bullet_fem
#endif
