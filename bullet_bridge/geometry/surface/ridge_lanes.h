// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/coarse_box.h"

namespace bullet_fem
{

/// Four ridges in single precision as SIMD lanes, component by component.
struct RidgeLanes
{
    static constexpr int kCount = 4;

    FloatLanes m_low[3], m_high[3], m_changeLow[3], m_changeHigh[3];  ///< as in CoarseBox [m]
    FloatLanes m_start[3], m_along[3];                                ///< one end, and the vector to the other end [m]
    FloatLanes m_length;  ///< sum of the magnitudes of m_along's components [m]

    /// Lanes without a ridge: they meet nothing.
    static RidgeLanes empty();

    /// Sets the ridge of one lane: its box, its start, and the vector from there to its other end [m].
    void set(int lane, const CoarseBox& box, const Vec3& start, const Vec3& along);

    /// One of the ridges, copied to all lanes.
    RidgeLanes spread(int lane) const;
};

/// Search distances between two ridges.
struct RidgeReach
{
    float m_near, m_band;  ///< at the start, and during the motion that the boxes are swept over [m]
    float m_rounding;      ///< rounding error of differences of m_start [m]
};

/// Possible contacts per lane: false only where contact is excluded.
struct RidgesMay
{
    LaneMask m_cross;  ///< near at the start, with the nearest points of the lines between the ends
    LaneMask m_meet;   ///< they come within the band during the motion
};

/// Tests the ridges of a and b lane by lane, conservatively.
RidgesMay ridgesMay(const RidgeLanes& a, const RidgeLanes& b, const RidgeReach& reach);

}  // namespace bullet_fem
