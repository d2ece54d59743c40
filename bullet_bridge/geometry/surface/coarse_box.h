// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>

#include "bullet_bridge/geometry/surface/lanes.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A length in single precision, rounded up [m].
inline float coarse(double length)
{
    return static_cast<float>(length) * (1 + 1e-6f);
}

/// A SweptBox in single precision, rounded outward, for conservative tests: they may say yes where the exact test says
/// no, but never the reverse, anywhere in the world.
struct alignas(64) CoarseBox  // one cache line
{
    FloatLanes m_low, m_high;              ///< at the start [m]; the fourth component is 0
    FloatLanes m_changeLow, m_changeHigh;  ///< displacement in a step [m]

    /// The empty box: it meets no other.
    static CoarseBox empty()
    {
        constexpr float kMax = std::numeric_limits<float>::max();
        constexpr FloatLanes kHigh = {kMax, kMax, kMax, 0}, kLow = {-kMax, -kMax, -kMax, 0};
        return {kHigh, kLow, kHigh, kLow};
    }

    bool isEmpty() const { return m_low[0] > m_high[0]; }

    /// The box of a point with displacement `change`.
    static CoarseBox of(const Vec3& point, const Vec3& change)
    {
        const FloatLanes x = {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z), 0};
        const FloatLanes d = {static_cast<float>(change.x), static_cast<float>(change.y), static_cast<float>(change.z),
                              0};
        return {x - rounding(x), x + rounding(x), d - rounding(d), d + rounding(d)};
    }

    /// Extends the box to contain b.
    void add(const CoarseBox& b)
    {
        m_low = laneMin(m_low, b.m_low);
        m_high = laneMax(m_high, b.m_high);
        m_changeLow = laneMin(m_changeLow, b.m_changeLow);
        m_changeHigh = laneMax(m_changeHigh, b.m_changeHigh);
    }

    /// Extends the motion to a number of steps at constant velocity.
    void last(int steps)
    {
        m_changeLow *= static_cast<float>(steps);
        m_changeHigh *= static_cast<float>(steps);
    }

    /// False only if all points of the boxes are farther than `reach` [m] apart at the start.
    bool startsWithin(const CoarseBox& b, float reach) const
    {
        const FloatLanes apart = laneMax(m_low - b.m_high, b.m_low - m_high);
        return !isAny(kShrink * apart > reach);
    }

    /// False only if no points of the two boxes come within `reach` [m] of each other in straight relative motion; a
    /// common motion has no effect.
    bool meets(const CoarseBox& b, float reach) const
    {
        const FloatLanes none = {};
        const FloatLanes above = kShrink * (m_low - b.m_high) + laneMin(none, m_changeLow - b.m_changeHigh);
        const FloatLanes below = kShrink * (b.m_low - m_high) + laneMin(none, b.m_changeLow - m_changeHigh);
        return !isAny(laneMax(above, below) > reach);
    }

    /// Sum of the side lengths at the start [m].
    float extent() const { return (m_high[0] - m_low[0]) + (m_high[1] - m_low[1]) + (m_high[2] - m_low[2]); }

    // Covers the rounding of four operations. Rounding matters only where boxes are apart, and there it is relative to
    // the distance at the start: the difference of close values is exact.
    static constexpr float kShrink = 1 - 1e-6f;

private:
    // Upper bound of the error of rounding to single precision.
    static FloatLanes rounding(const FloatLanes& a)
    {
        constexpr FloatLanes kTiny = {std::numeric_limits<float>::min(), std::numeric_limits<float>::min(),
                                      std::numeric_limits<float>::min(), 0};
        return 2e-7f * laneMax(a, -a) + kTiny;
    }
};

}  // namespace bullet_fem
