// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/coarse_box.h"

namespace bullet_fem
{

/// Ridges beside each other, in single precision: component by component, a lane each.
struct RidgeLanes
{
    static constexpr int kCount = 4;

    FloatLanes m_low[3], m_high[3], m_changeLow[3], m_changeHigh[3];  ///< as in CoarseBox [m]
    FloatLanes m_start[3], m_along[3];                                ///< one end, and the way to the other [m]
    FloatLanes m_length;                                              ///< sum of the latter's components [m]

    /// Lanes of nothing, which meet nothing.
    static RidgeLanes empty();

    void set(int lane, const CoarseBox& box, const Vec3& start, const Vec3& along);

    /// One of the ridges in all lanes.
    RidgeLanes spread(int lane) const;
};

/// What is looked for between two ridges.
struct RidgeReach
{
    float m_near, m_band;  ///< at the start, and within the steps that boxes are swept over [m]
    float m_rounding;      ///< of differences between two starts [m]
};

/// What may be between the ridges in a lane each: false only where it cannot be.
struct RidgesMay
{
    LaneMask m_cross;  ///< near at the start, with the nearest points of their lines between their ends
    LaneMask m_meet;   ///< they come within the band
};

RidgesMay ridgesMay(const RidgeLanes& a, const RidgeLanes& b, const RidgeReach& reach);

}  // namespace bullet_fem
