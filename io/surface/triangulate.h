// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Appends the n - 2 triangles of a polygon given by its `corners` (indices into `positions`), by ear clipping; keeps
/// the polygon's orientation. Fewer than three corners give none. If no ear is left (a polygon that crosses itself),
/// and above 256 corners (clipping costs up to n^3), the remaining polygon becomes a fan: the surface stays closed and
/// keeps its volume.
void triangulatePolygon(const std::vector<Vec3>& positions, std::vector<int> corners, std::vector<Triangle>& triangles);

}  // namespace bullet_fem
