// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/cage/surface_repair.h"

namespace bullet_fem
{

/// Properties of a surface before filling.
struct SurfaceInspection
{
    RepairedSurface m_repaired;
    Vec3 m_low, m_high;        ///< bounding box of the vertices that triangles use [m]
    std::vector<char> m_used;  ///< per vertex: 1 if used by a triangle
    double m_area = 0;         ///< sum of the triangles' areas [m2], > 0
    int m_edges = 0;           ///< number of edges, with coincident vertices merged
    int m_openEdges = 0;       ///< edges whose triangles do not cancel; 0 if closed
    int m_pieces = 0;          ///< connected components (through edges or vertices)
};

/// Inspects and repairs a surface. Throws std::invalid_argument naming value, range and remedy: no triangles, an index
/// out of range, a vertex that is not finite, a surface far smaller than its distance from the origin, triangles that
/// disagree even after repair, a flat surface, and an open one whose triangles nearly all face one way: these have no
/// inside.
SurfaceInspection inspectSurface(const SurfaceMesh& surface);

}  // namespace bullet_fem
