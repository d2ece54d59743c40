// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/surface_inspection.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// What the boundary nodes of a cage are moved toward.
struct SnapTarget
{
    const SurfaceInspection& m_surface;
    const SurfaceWinding& m_winding;  ///< about the centre of the surface's bounding box
    double m_share = 1;               ///< of the way to the nearest point of the surface, in [0, 1]
    double m_cellSize = 0;            ///< [m]
};

/// Least mean ratio that snapping leaves an element.
constexpr double kSnappedQuality = 0.3;

/// The cage with its boundary nodes moved straight toward the nearest point of the surface, so far that no element is
/// below kSnappedQuality, that every boundary triangle moves inward (so the cage only shrinks, and never meets itself),
/// and that none sweeps over a triangle of the surface: what the cage enclosed it still encloses, vertices and
/// triangles alike, to 1e-9 cells a move. Around an open surface nodes also stay where the winding number is below 1/2.
/// Nodes move one after the other, in rounds of a quarter of the way; the same bits on every call.
TetMesh snapped(const TetMesh& cage, const SnapTarget& target);

}  // namespace bullet_fem
