// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/grading.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

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

}  // namespace bullet_fem
