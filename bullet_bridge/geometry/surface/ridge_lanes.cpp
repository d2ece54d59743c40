// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/ridge_lanes.h"

#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr float kLaneRounding = 1e-6f;  // relative rounding error of a product

FloatLanes spreadLane(const FloatLanes& lanes, int lane)
{
    const float a = lanes[lane];
    return FloatLanes{a, a, a, a};
}

FloatLanes magnitude(const FloatLanes& a)
{
    return laneMax(a, -a);
}

void crossLanes(const FloatLanes a[3], const FloatLanes b[3], FloatLanes product[3])
{
    for (int c = 0; c < 3; ++c) product[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

FloatLanes dotLanes(const FloatLanes a[3], const FloatLanes b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// nearestOfLines() in single precision, with tolerances for its rounding: false only where the nearest points are not
// between the ends.
LaneMask mayCrossBetweenEnds(const RidgeLanes& a, const RidgeLanes& b, float startRounding)
{
    FloatLanes r[3], n[3], s[3];
    for (int c = 0; c < 3; ++c) r[c] = b.m_start[c] - a.m_start[c];
    crossLanes(a.m_along, b.m_along, n);
    crossLanes(n, r, s);
    const FloatLanes onA = dotLanes(s, b.m_along), onB = dotLanes(s, a.m_along), whole = dotLanes(n, n);
    const FloatLanes distance = magnitude(r[0]) + magnitude(r[1]) + magnitude(r[2]);
    const FloatLanes area = a.m_length * b.m_length;
    const FloatLanes error =
        area * ((a.m_length + b.m_length) * (kLaneRounding * distance + startRounding) + kLaneRounding * area);
    return (laneMin(onA, onB) >= -error) & (laneMax(onA, onB) <= whole + error);
}

}  // namespace

RidgeLanes RidgeLanes::empty()
{
    RidgeLanes lanes = {};
    const CoarseBox nothing = CoarseBox::empty();
    for (int lane = 0; lane < kCount; ++lane) lanes.set(lane, nothing, {}, {});
    return lanes;
}

void RidgeLanes::set(int lane, const CoarseBox& box, const Vec3& start, const Vec3& along)
{
    float length = 0;
    for (int c = 0; c < 3; ++c)
    {
        m_low[c][lane] = box.m_low[c];
        m_high[c][lane] = box.m_high[c];
        m_changeLow[c][lane] = box.m_changeLow[c];
        m_changeHigh[c][lane] = box.m_changeHigh[c];
        m_start[c][lane] = static_cast<float>(start[c]);
        m_along[c][lane] = static_cast<float>(along[c]);
        length += std::fabs(m_along[c][lane]);
    }
    m_length[lane] = length;
}

RidgeLanes RidgeLanes::spread(int lane) const
{
    RidgeLanes lanes;
    for (int c = 0; c < 3; ++c)
    {
        lanes.m_low[c] = spreadLane(m_low[c], lane);
        lanes.m_high[c] = spreadLane(m_high[c], lane);
        lanes.m_changeLow[c] = spreadLane(m_changeLow[c], lane);
        lanes.m_changeHigh[c] = spreadLane(m_changeHigh[c], lane);
        lanes.m_start[c] = spreadLane(m_start[c], lane);
        lanes.m_along[c] = spreadLane(m_along[c], lane);
    }
    lanes.m_length = spreadLane(m_length, lane);
    return lanes;
}

RidgesMay ridgesMay(const RidgeLanes& a, const RidgeLanes& b, const RidgeReach& reach)
{
    const FloatLanes none = {};
    FloatLanes apart = none, apartOnTheWay = none;
    for (int c = 0; c < 3; ++c)
    {
        const FloatLanes above = CoarseBox::kShrink * (a.m_low[c] - b.m_high[c]);
        const FloatLanes below = CoarseBox::kShrink * (b.m_low[c] - a.m_high[c]);
        const FloatLanes closesAbove = laneMin(none, a.m_changeLow[c] - b.m_changeHigh[c]);
        const FloatLanes closesBelow = laneMin(none, b.m_changeLow[c] - a.m_changeHigh[c]);
        apart = laneMax(apart, laneMax(above, below));
        apartOnTheWay = laneMax(apartOnTheWay, laneMax(above + closesAbove, below + closesBelow));
    }
    RidgesMay may;
    may.m_meet = ~(apartOnTheWay > reach.m_band);
    may.m_cross = ~(apart > reach.m_near);
    if (isAny(may.m_cross)) may.m_cross &= mayCrossBetweenEnds(a, b, reach.m_rounding);
    return may;
}

}  // namespace bullet_fem
