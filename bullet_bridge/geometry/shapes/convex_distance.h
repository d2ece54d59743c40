// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/shapes/minkowski_simplex.h"
#include "bullet_bridge/geometry/shapes/shape_distance.h"

/// Distance of a convex core and a soft node or triangle in double precision. Bullet's own btGjkEpaSolver2 does not
/// serve: in the float build it works to absolute tolerances (it takes support points nearer than 1 cm for one and the
/// same), so it is wrong for triangles of millimetres.
namespace bullet_fem
{

/// Distance to the rounded core, everything in the core's frame, by GJK; if the cores overlap, by penetration() below.
/// [Gilbert, Johnson, Keerthi 1988]
/// False, and `distance` untouched, if farther than maxDistance [m] or if a number is not finite. Never allocates.
bool convexDistance(const MinkowskiDifference& difference, double maxDistance, SurfaceDistance& distance);

/// The same for cores that overlap or touch, by the expanding polytope algorithm [van den Bergen 2001]: the shortest
/// way to move the soft side out. `nearest` is where GJK ended; it gives the barycentrics if the difference is flat.
SurfaceDistance penetration(const MinkowskiDifference& difference, const MinkowskiSimplex& nearest);

}  // namespace bullet_fem
