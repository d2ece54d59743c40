// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/vec3.h"

namespace bullet_fem
{

/// A length in single precision, rounded up [m].
inline float coarse(double length)
{
    return static_cast<float>(length) * (1 + 1e-6f);
}

/// A SweptBox in single precision, rounded outward, for quick answers: these may be yes where the exact one is no,
/// never the other way round, wherever in the world the box is.
struct alignas(16) CoarseBox
{
    float m_low[4], m_high[4];              ///< at the start [m]; the fourth component is 0
    float m_changeLow[4], m_changeHigh[4];  ///< [m]

    /// Of nothing: meets nothing.
    static CoarseBox empty();

    /// A point that moves by `change`.
    static CoarseBox of(const Vec3& point, const Vec3& change);

    void add(const CoarseBox& b);

    /// Makes it hold for so many steps of the same motion.
    void last(int steps);

    /// False only if no two points of this and the other are within `reach` [m] of each other at the start.
    bool startsWithin(const CoarseBox& b, float reach) const;

    /// False only if no two points of this and the other come within `reach` [m] of each other, moving relative to each
    /// other in a straight line: what both have in common does not matter.
    bool meets(const CoarseBox& b, float reach) const;

    /// Sum of the sides at the start [m].
    float extent() const { return (m_high[0] - m_low[0]) + (m_high[1] - m_low[1]) + (m_high[2] - m_low[2]); }
};

}  // namespace bullet_fem
