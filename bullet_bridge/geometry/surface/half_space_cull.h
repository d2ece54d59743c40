// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// A cheap sufficient test that points in front of a closed surface along a direction are outside of it and far from
/// it, in agreement with the search for the nearest triangle.
///
/// The distance of a point from the surface is at least its height in front of all vertices. The nearest point of the
/// surface is at most as far as the foremost vertex. If no triangle that faces away is that close, all triangles at the
/// nearest point face forward, and so does the normal there that tells inside from outside. The search for the nearest
/// triangle would thus agree, even if other parts of the surface are crumpled.
class HalfSpaceCull
{
public:
    /// Proves nothing: isFarOutside() is always false.
    HalfSpaceCull() = default;

    /// `direction` is a unit vector from the surface to the points.
    HalfSpaceCull(const SoftSurface& surface, const Vec3& direction);

    /// True if x [m] is proved to be outside and farther from the surface than `distance` [m].
    bool isFarOutside(const Vec3& x, double distance) const;

private:
    Vec3 m_direction, m_foremost;
    double m_front = VectorBounds::kInfinity;  // position of the foremost vertex along the direction [m]
    double m_back = -VectorBounds::kInfinity;  // foremost vertex of triangles that face away, along the direction [m]
};

}  // namespace bullet_fem
