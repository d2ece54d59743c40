// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// A surface without duplicate triangles and with consistent orientation.
struct RepairedSurface
{
    SurfaceMesh m_surface;      ///< the repaired surface; vertices are unchanged
    std::vector<int> m_welded;  ///< per vertex: the lowest vertex at its position
    int m_duplicates = 0;       ///< duplicate triangles dropped: equal corner positions and equal orientation
    int m_degenerate = 0;       ///< triangles of zero area; kept to close edges, without other effect
    int m_turned = 0;           ///< triangles reversed to agree with their neighbours
};

/// Repairs duplicates and orientation without moving a vertex. Triangles are adjacent over edges with exactly two.
/// Patches of consistent orientation are kept, even if inside out. In other patches triangles are reversed until they
/// agree: the minority if it is at most a quarter, else those that make the enclosed volume positive. Requires indices
/// in range and finite positions. Allocates.
BULLETFEM_API RepairedSurface repairSurface(const SurfaceMesh& surface);

}  // namespace bullet_fem
