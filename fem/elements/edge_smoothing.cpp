// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/common/vector_targets.h"
#include "fem/elements/smoothed_elements.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/edge_smoothing.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR

// For processors without vector instructions.
template <class Real>
void averageOver(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, Range domains)
{
    reference::averageStrains(smoothing, strain, domains);
}

#else
namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
HWY_INLINE void averageOver(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, Range domains)
{
    const hn::CappedTag<Real, 4> d;
    constexpr int kN = static_cast<int>(hn::MaxLanes(d));
    const Real* quads = &strain.m_element->m_quad[0][0][0];
    for (int k = domains.m_begin; k < domains.m_end; ++k)
        for (int c = 0; c < 4; c += kN)
        {
            auto first = hn::Zero(d), second = hn::Zero(d);
            for (int i = smoothing.m_start[k]; i < smoothing.m_start[k + 1]; ++i)
            {
                const Real* quad = quads + 4 * static_cast<std::ptrdiff_t>(smoothing.m_place[i]) + c;
                const auto weight = hn::Set(d, smoothing.m_weight[i]);
                first = hn::MulAdd(weight, hn::Load(d, quad), first);
                second = hn::MulAdd(weight, hn::Load(d, quad + 4 * kLanes), second);
            }
            hn::Store(first, d, strain.m_domain[k].m_quad[0] + c);
            hn::Store(second, d, strain.m_domain[k].m_quad[1] + c);
        }
}

#endif

void averageFloat(const EdgeSmoothing<float>& smoothing, const SmoothedStrain<float>& strain, Range domains)
{
    averageOver(smoothing, strain, domains);
}

void averageDouble(const EdgeSmoothing<double>& smoothing, const SmoothedStrain<double>& strain, Range domains)
{
    averageOver(smoothing, strain, domains);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(averageFloat);
HWY_EXPORT(averageDouble);

template <>
void averageStrains(const EdgeSmoothing<float>& smoothing, const SmoothedStrain<float>& strain, Range domains)
{
    HWY_DYNAMIC_DISPATCH(averageFloat)(smoothing, strain, domains);
}

template <>
void averageStrains(const EdgeSmoothing<double>& smoothing, const SmoothedStrain<double>& strain, Range domains)
{
    HWY_DYNAMIC_DISPATCH(averageDouble)(smoothing, strain, domains);
}

template <class Real>
EdgeSmoothing<Real>::EdgeSmoothing(const RestShape& shape, const ElementLanes& lanes)
{
    const EdgeDomains& domains = shape.m_edgeDomains;
    if (domains.empty()) return;
    m_lanes.resize(lanes.blockCount());
    for (int lane = 0; lane < lanes.blockCount() * kLanes; ++lane)
    {
        const int e = lanes.m_element[lane];
        BlockShares& to = m_lanes[lane / kLanes];
        to.m_own[lane % kLanes] = static_cast<Real>(1 - domains.m_share[e]);
        to.m_ofDomain[lane % kLanes] = static_cast<Real>(domains.m_share[e] / 6);
        for (int k = 0; k < 6; ++k) to.m_domain[lane % kLanes][k] = domains.m_domain[e][k];
    }
    m_start = domains.m_start;
    for (const int e : domains.m_element)
    {
        const int lane = lanes.m_lane[e];
        m_place.push_back(lane / kLanes * 2 * kLanes + lane % kLanes);
    }
    m_weight.assign(domains.m_weight.begin(), domains.m_weight.end());
}

template struct EdgeSmoothing<float>;
template struct EdgeSmoothing<double>;

}  // namespace bullet_fem
#endif
