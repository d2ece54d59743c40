// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for each instruction set; the best one is chosen at run time.
#include "benchmarks/kernels/machine_limits.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "benchmarks/kernels/machine_limits.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
constexpr std::size_t kN = hn::MaxLanes(D());

const char* targetHere()
{
    return hwy::TargetName(HWY_TARGET);
}

/// Uses eight independent sums, so that additions do not wait for each other.
float readHere(const float* values, std::size_t count)
{
    const D d;
    V s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
    for (std::size_t i = 0; i < count; i += 8 * kN)
    {
        s0 = hn::Add(s0, hn::Load(d, values + i));
        s1 = hn::Add(s1, hn::Load(d, values + i + kN));
        s2 = hn::Add(s2, hn::Load(d, values + i + 2 * kN));
        s3 = hn::Add(s3, hn::Load(d, values + i + 3 * kN));
        s4 = hn::Add(s4, hn::Load(d, values + i + 4 * kN));
        s5 = hn::Add(s5, hn::Load(d, values + i + 5 * kN));
        s6 = hn::Add(s6, hn::Load(d, values + i + 6 * kN));
        s7 = hn::Add(s7, hn::Load(d, values + i + 7 * kN));
    }
    s0 = hn::Add(hn::Add(hn::Add(s0, s1), hn::Add(s2, s3)), hn::Add(hn::Add(s4, s5), hn::Add(s6, s7)));
    return hn::GetLane(hn::SumOfLanes(d, s0));
}

/// Uses eight chains: enough to keep two units with a latency of four cycles busy, and few enough for the sixteen
/// registers of the narrow instruction sets.
float multiplyAddHere(int rounds)
{
    const D d;
    const V factor = hn::Set(d, 0.999f), term = hn::Set(d, 0.001f);
    V a0 = hn::Set(d, 1.f), a1 = hn::Set(d, 2.f), a2 = hn::Set(d, 3.f), a3 = hn::Set(d, 4.f), a4 = hn::Set(d, 5.f),
      a5 = hn::Set(d, 6.f), a6 = hn::Set(d, 7.f), a7 = hn::Set(d, 8.f);  // equal ones would be merged by the compiler
    for (int k = 0; k < 4 * rounds; ++k)
    {
        a0 = hn::MulAdd(a0, factor, term);
        a1 = hn::MulAdd(a1, factor, term);
        a2 = hn::MulAdd(a2, factor, term);
        a3 = hn::MulAdd(a3, factor, term);
        a4 = hn::MulAdd(a4, factor, term);
        a5 = hn::MulAdd(a5, factor, term);
        a6 = hn::MulAdd(a6, factor, term);
        a7 = hn::MulAdd(a7, factor, term);
    }
    a0 = hn::Add(hn::Add(hn::Add(a0, a1), hn::Add(a2, a3)), hn::Add(hn::Add(a4, a5), hn::Add(a6, a7)));
    return hn::GetLane(hn::SumOfLanes(d, a0));
}

double operationsHere(int rounds)
{
    return 32.0 * 2 * kN * rounds;
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(targetHere);
HWY_EXPORT(readHere);
HWY_EXPORT(multiplyAddHere);
HWY_EXPORT(operationsHere);

const char* vectorTarget()
{
    return HWY_DYNAMIC_DISPATCH(targetHere)();
}

float readOnce(const float* values, std::size_t count)
{
    return HWY_DYNAMIC_DISPATCH(readHere)(values, count);
}

float multiplyAdd(int rounds)
{
    return HWY_DYNAMIC_DISPATCH(multiplyAddHere)(rounds);
}

double multiplyAddOperations(int rounds)
{
    return HWY_DYNAMIC_DISPATCH(operationsHere)(rounds);
}

}  // namespace bullet_fem
#endif
