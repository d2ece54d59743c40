// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/cage/surface_mesh.h"

namespace bullet_fem
{

/// Closed surfaces with outward triangles, made for tests.
SurfaceMesh boxSurface(const Vec3& low, const Vec3& high);                 ///< 12 triangles, two a side
SurfaceMesh sphereSurface(double radius, const Vec3& centre, int levels);  ///< icosahedron, split `levels` times
SurfaceMesh torusSurface(double major, double minor, int around);          ///< around z; around x around / 2 quads

/// The union of both triangle soups.
SurfaceMesh joined(const SurfaceMesh& a, const SurfaceMesh& b);
/// The surface with all triangles reversed.
SurfaceMesh flipped(SurfaceMesh surface);
/// The surface without the triangles [first, last).
SurfaceMesh without(SurfaceMesh surface, int first, int last);

/// True if a triangle of the surface crosses a face of the cage's boundary, deeper than `depth` [m] at each edge.
bool piercesBoundary(const Cage& cage, const SurfaceMesh& surface, double depth);

/// Settings for a cage with cells of this size [m].
CageSettings withCell(double cellSize);

}  // namespace bullet_fem
