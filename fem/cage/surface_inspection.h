// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/cage/surface_repair.h"

namespace bullet_fem
{

/// What can be said of a surface before anything is filled.
struct SurfaceInspection
{
    RepairedSurface m_repaired;
    Vec3 m_low, m_high;        ///< bounding box of the vertices that triangles use [m]
    std::vector<char> m_used;  ///< per vertex: 1 if a triangle uses it
    double m_area = 0;         ///< sum of the triangles' areas [m2], > 0
    int m_edges = 0;           ///< edges, coincident vertices taken as one
    int m_openEdges = 0;       ///< edges whose triangles do not cancel; 0 if closed
    int m_pieces = 0;          ///< parts that no edge or vertex joins
};

/// Throws std::invalid_argument naming value, range and remedy: no triangles, an index out of range, a vertex that is
/// not finite, a surface far smaller than its distance from the origin, one whose triangles disagree even after repair,
/// a flat one, and an open one whose triangles nearly all face the same way: those have no inside.
SurfaceInspection inspectSurface(const SurfaceMesh& surface);

}  // namespace bullet_fem
