// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>

#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// A separating plane between two surfaces. Points of one surface that stay in front of the plane by more than the
/// search distance have no contact with the surface behind it. Axis-aligned boxes cannot tell this where surfaces meet
/// at an angle.
class BeyondPlane
{
public:
    /// The plane through the point of `surface` that is farthest in a direction (unit). `steps`: time of the motion, in
    /// steps.
    BeyondPlane(const SoftSurface& surface, const Vec3& direction, int steps) : m_direction(direction), m_steps(steps)
    {
        for (int i : surface.topology().vertices())
        {
            m_max = std::max(m_max, dot(direction, surface.position()[i]));
            m_maxChange = std::max(m_maxChange, dot(direction, surface.change()[i]));
        }
    }

    /// Signed distance of a point in front of the plane [m].
    double distance(const Vec3& x) const { return dot(m_direction, x) - m_max; }

    /// True if points at x and y with displacements dx and dy per step, and all points between them, stay farther than
    /// `near` [m] at the start and farther than `band` [m] during the motion.
    bool isBeyond(const Vec3& x, const Vec3& dx, const Vec3& y, const Vec3& dy, double near, double band) const
    {
        const double start = std::min(distance(x), distance(y)) - 1e-12 * (std::fabs(m_max) + near);
        const double closing = m_maxChange - std::min(dot(m_direction, dx), dot(m_direction, dy));
        return start > near && start - m_steps * std::max(0.0, closing) > band;
    }

private:
    Vec3 m_direction;
    int m_steps;
    double m_max = -VectorBounds::kInfinity, m_maxChange = -VectorBounds::kInfinity;
};

}  // namespace bullet_fem
