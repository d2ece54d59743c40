// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// A quick proof that points in front of a closed surface, seen along a direction, are outside of it and far from it,
/// for those of which it would be found out by looking for the nearest triangle.
///
/// A point is as far from the surface as it is in front of all vertices. The nearest point of the surface is no farther
/// than its foremost vertex; if no triangle that turns its back is so near, those at the nearest point all face
/// forward, and so does the normal there that tells outside from inside: however the rest of the surface may be
/// crumpled, the search for the nearest triangle would say the same.
class OutsideProof
{
public:
    /// No point is outside of this.
    OutsideProof() = default;

    /// Seen along a unit vector, from the surface to the points.
    OutsideProof(const SoftSurface& surface, const Vec3& direction);

    /// False wherever it cannot be proved that x [m] is outside and farther from the surface than `distance` [m].
    bool isFarOutside(const Vec3& x, double distance) const;

private:
    Vec3 m_direction, m_foremost;
    double m_front = VectorBounds::kInfinity;  // of the foremost vertex, along the direction [m]
    double m_back = -VectorBounds::kInfinity;  // likewise, of those of triangles that turn their backs
};

}  // namespace bullet_fem
