// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// A surface whose triangles count once and agree with their neighbours.
struct RepairedSurface
{
    SurfaceMesh m_surface;      ///< vertices as they were
    std::vector<int> m_welded;  ///< per vertex: the lowest vertex at the same place
    int m_duplicates = 0;       ///< triangles left out: the same places in the same sense as an earlier one
    int m_degenerate = 0;       ///< triangles without area; kept, they close edges and count nothing
    int m_turned = 0;           ///< triangles that turned against their neighbours and were turned over
};

/// Mends what can be mended without moving a vertex. Triangles hang together over edges that have exactly two. Patches
/// whose triangles agree stay as they are, be they inside out; in others triangles are turned until they agree, the
/// smaller share of them if it is at most a quarter, else so that the patch encloses a positive volume. Indices must be
/// in range, positions finite.
BULLETFEM_API RepairedSurface repairSurface(const SurfaceMesh& surface);

}  // namespace bullet_fem
