// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "bullet_fem/fem/cage/cage_progress.h"
#include "fem/cage/grading.h"
#include "fem/cage/surface_inspection.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// Number of cubes or elements between two progress calls.
constexpr int kCellsBetweenProgress = 1024;

/// Reports progress; throws CageCancelled if the callback returns false.
inline void tell(const CageProgress& progress, double share)
{
    if (progress && !progress(share)) throw CageCancelled();
}

/// Reports the progress of a loop over `count` cubes or elements, from one share to another.
inline void tellLoop(const CageProgress& progress, std::size_t at, std::size_t count, double from, double to)
{
    if (at % kCellsBetweenProgress == 0) tell(progress, from + (to - from) * double(at) / double(count));
}

/// The progress callback of a stage that covers the work from one share to another. `whole` must outlive it.
inline CageProgress stageOf(const CageProgress& whole, double from, double to)
{
    if (!whole) return {};
    return [&whole, from, to](double share) { return whole(from + (to - from) * share); };
}

/// Throws std::invalid_argument naming value, range and remedy on settings that are wrong for any surface.
void checkSettings(const CageSettings& settings);

/// A cell size and the grading of its cells.
struct CageSize
{
    double m_cellSize = 0;  ///< [m]
    Grading m_grading;
};

/// The cell size whose lattice comes nearest to m_targetTets elements: regula falsi and bisection alternate over the
/// logarithms, until the count is within 3 % or 20 lattices were tried. Cells of a graded cage become up to twice as
/// long as uniform ones would be; if the count is still too high, the grading is reduced. Deterministic. The winding
/// number's origin is the centre of the surface's bounding box.
CageSize findCageSize(const SurfaceInspection& surface, const SurfaceWinding& winding, const CageSettings& settings);

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
