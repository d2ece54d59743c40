// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/surface_mesh.h"

namespace bullet_fem
{

/// What can be said of a surface before anything is filled.
struct SurfaceInspection
{
    Vec3 m_low, m_high;        ///< bounding box of the vertices that triangles use [m]
    std::vector<char> m_used;  ///< per vertex: 1 if a triangle uses it
    double m_area = 0;         ///< sum of the triangles' areas [m2], > 0
    int m_openEdges = 0;       ///< edges whose triangles do not cancel, coincident vertices taken as one; 0 if closed
};

/// Throws std::invalid_argument naming value, range and remedy: no triangles, an index out of range, a vertex that is
/// not finite, a surface far smaller than its distance from the origin, one whose triangles are oriented
/// at random, a flat one, and an open one whose triangles nearly all face the same way: those have no inside.
SurfaceInspection inspectSurface(const SurfaceMesh& surface);

}  // namespace bullet_fem
