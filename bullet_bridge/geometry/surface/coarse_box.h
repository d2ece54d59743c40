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

/// A SweptBox in single precision, rounded outward, for quick answers: these may be yes where the exact one is no,
/// never the other way round, wherever in the world the box is.
struct alignas(64) CoarseBox  // a cache line
{
    FloatLanes m_low, m_high;              ///< at the start [m]; the fourth component is 0
    FloatLanes m_changeLow, m_changeHigh;  ///< [m]

    /// Of nothing: meets nothing.
    static CoarseBox empty()
    {
        constexpr float kMost = std::numeric_limits<float>::max();
        constexpr FloatLanes kHigh = {kMost, kMost, kMost, 0}, kLow = {-kMost, -kMost, -kMost, 0};
        return {kHigh, kLow, kHigh, kLow};
    }

    bool isEmpty() const { return m_low[0] > m_high[0]; }

    /// A point that moves by `change`.
    static CoarseBox of(const Vec3& point, const Vec3& change)
    {
        const FloatLanes x = {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z), 0};
        const FloatLanes d = {static_cast<float>(change.x), static_cast<float>(change.y), static_cast<float>(change.z),
                              0};
        return {x - rounding(x), x + rounding(x), d - rounding(d), d + rounding(d)};
    }

    void add(const CoarseBox& b)
    {
        m_low = laneMin(m_low, b.m_low);
        m_high = laneMax(m_high, b.m_high);
        m_changeLow = laneMin(m_changeLow, b.m_changeLow);
        m_changeHigh = laneMax(m_changeHigh, b.m_changeHigh);
    }

    /// Makes it hold for so many steps of the same motion.
    void last(int steps)
    {
        m_changeLow *= static_cast<float>(steps);
        m_changeHigh *= static_cast<float>(steps);
    }

    /// False only if no two points of this and the other are within `reach` [m] of each other at the start.
    bool startsWithin(const CoarseBox& b, float reach) const
    {
        const FloatLanes apart = laneMax(m_low - b.m_high, b.m_low - m_high);
        return !isAny(kShrink * apart > reach);
    }

    /// False only if no two points of this and the other come within `reach` [m] of each other, moving relative to each
    /// other in a straight line: what both have in common does not matter.
    bool meets(const CoarseBox& b, float reach) const
    {
        const FloatLanes none = {};
        const FloatLanes above = kShrink * (m_low - b.m_high) + laneMin(none, m_changeLow - b.m_changeHigh);
        const FloatLanes below = kShrink * (b.m_low - m_high) + laneMin(none, b.m_changeLow - m_changeHigh);
        return !isAny(laneMax(above, below) > reach);
    }

    /// Sum of the sides at the start [m].
    float extent() const { return (m_high[0] - m_low[0]) + (m_high[1] - m_low[1]) + (m_high[2] - m_low[2]); }

    // More than what four operations round away. Where boxes are apart, all they take is a share of the distance at the
    // start: of two values that are near each other the difference is exact.
    static constexpr float kShrink = 1 - 1e-6f;

private:
    // More than what rounding to single precision can have changed.
    static FloatLanes rounding(const FloatLanes& a)
    {
        constexpr FloatLanes kTiny = {std::numeric_limits<float>::min(), std::numeric_limits<float>::min(),
                                      std::numeric_limits<float>::min(), 0};
        return 2e-7f * laneMax(a, -a) + kTiny;
    }
};

}  // namespace bullet_fem
