// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/grading.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// Throws std::invalid_argument naming value, range and remedy: what is wrong with the settings whatever the surface.
void checkSettings(const CageSettings& settings);

/// A cell size, and how far its cells are halved if they are.
struct CageSize
{
    double m_cellSize = 0;  ///< [m]
    Grading m_grading;
};

/// The size whose lattice comes nearest to m_targetTets elements, of those looked at: regula falsi and bisection in
/// turn over the logarithms, until the count is within 3 % or 20 lattices were looked at. Cells of a graded cage become
/// up to twice as long as they would be alike; where these are still too many, the grading becomes less. The same bits
/// on every call. The winding number is about the centre of the surface's bounding box.
CageSize findCageSize(const SurfaceInspection& surface, const SurfaceWinding& winding, const CageSettings& settings);

}  // namespace bullet_fem
