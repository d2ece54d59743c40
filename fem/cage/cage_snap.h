// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/surface_inspection.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// The target that boundary nodes of a cage move toward.
struct SnapTarget
{
    const SurfaceInspection& m_surface;
    const SurfaceWinding& m_winding;  ///< relative to the centre of the surface's bounding box
    double m_share = 1;               ///< share of the way to the nearest point of the surface [-], in [0, 1]
    double m_cellSize = 0;            ///< [m]
};

/// Minimum mean ratio of an element after snapping.
constexpr double kSnappedQuality = 0.3;

/// The cage with its boundary nodes moved straight toward the nearest point of the surface, as far as no element falls
/// below kSnappedQuality, every boundary triangle moves inward (so that the cage only shrinks and never intersects
/// itself), and none sweeps over a triangle of the surface: all enclosed vertices and triangles stay enclosed, to 1e-9
/// cells a move. Around an open surface, no node moves to a point of winding number 1/2 or more. Nodes move one after
/// the other, in passes of a quarter of the way. Deterministic.
TetMesh snapped(const TetMesh& cage, const SnapTarget& target);

}  // namespace bullet_fem
