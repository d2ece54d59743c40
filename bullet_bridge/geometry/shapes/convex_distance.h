// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/shapes/minkowski_simplex.h"
#include "bullet_bridge/geometry/shapes/shape_distance.h"

/// Distance between a convex core and a soft node or triangle in double precision. Bullet's btGjkEpaSolver2 is not
/// suitable: its float build uses absolute tolerances (support points closer than 1 cm count as equal), so it fails for
/// triangles of millimetres.
namespace bullet_fem
{

/// Signed distance to the rounded core in the core's frame, by GJK [Gilbert, Johnson, Keerthi 1988], or by
/// penetration() if the core and the soft feature overlap. False, with `distance` unchanged, if it exceeds maxDistance
/// [m] or is not finite. Never allocates.
bool convexDistance(const MinkowskiDifference& difference, double maxDistance, SurfaceDistance& distance);

/// Penetration of overlapping or touching cores by the expanding polytope algorithm (EPA) [van den Bergen 2001]: the
/// shortest translation that separates the soft feature from the core. `nearest` is the final simplex of GJK; it gives
/// the barycentric coordinates if the Minkowski difference is flat.
SurfaceDistance penetration(const MinkowskiDifference& difference, const MinkowskiSimplex& nearest);

}  // namespace bullet_fem
