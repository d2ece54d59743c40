// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// An axis-aligned bounding box of vectors; initially empty.
struct VectorBounds
{
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3 m_low = {kInfinity, kInfinity, kInfinity}, m_high = {-kInfinity, -kInfinity, -kInfinity};

    /// Extends the box to contain b.
    void add(const VectorBounds& b)
    {
        for (int c = 0; c < 3; ++c)
        {
            m_low[c] = std::min(m_low[c], b.m_low[c]);
            m_high[c] = std::max(m_high[c], b.m_high[c]);
        }
    }

    /// Squared distance from p to the box; 0 inside.
    double squaredDistance(const Vec3& p) const
    {
        double sum = 0;
        for (int c = 0; c < 3; ++c)
        {
            const double d = std::max({m_low[c] - p[c], p[c] - m_high[c], 0.0});
            sum += d * d;
        }
        return sum;
    }
};

/// Bounds of points and of their displacements within a step.
struct SweptBox
{
    VectorBounds m_start, m_change;  ///< [m]

    /// The box of a point with displacement `change`.
    static SweptBox of(const Vec3& point, const Vec3& change) { return {{point, point}, {change, change}}; }

    /// Extends the bounds to contain b.
    void add(const SweptBox& b)
    {
        m_start.add(b.m_start);
        m_change.add(b.m_change);
    }

    /// False only if no points of the two boxes come within `reach` [m] of each other in straight relative motion; a
    /// common motion has no effect.
    bool meets(const SweptBox& b, double reach) const
    {
        const Vec3 &low = m_start.m_low, &high = m_start.m_high;
        for (int c = 0; c < 3; ++c)
        {
            if (low[c] + std::min(0.0, m_change.m_low[c] - b.m_change.m_high[c]) > b.m_start.m_high[c] + reach)
                return false;
            if (high[c] + std::max(0.0, m_change.m_high[c] - b.m_change.m_low[c]) < b.m_start.m_low[c] - reach)
                return false;
        }
        return true;
    }
};

/// Upper bound of the relative displacement of points of the two boxes [m].
inline double largestTravel(const SweptBox& a, const SweptBox& b)
{
    Vec3 most;
    for (int c = 0; c < 3; ++c)
        most[c] = std::fmax(std::fabs(a.m_change.m_high[c] - b.m_change.m_low[c]),
                            std::fabs(b.m_change.m_high[c] - a.m_change.m_low[c]));
    return norm(most);
}

}  // namespace bullet_fem
