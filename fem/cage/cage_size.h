// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/cage_lattice.h"
#include "fem/cage/winding_number.h"

namespace bullet_fem
{

/// Throws std::invalid_argument naming value, range and remedy: what is wrong with the settings whatever the surface.
void checkSettings(const CageSettings& settings);

/// The cell size [m] whose lattice comes nearest to m_targetTets elements, of those looked at: regula falsi and
/// bisection in turn over the logarithms, until the count is within 3 % or 20 lattices were looked at. The same bits on
/// every call. The winding number is about the centre of the surface's bounding box.
double findCellSize(const SurfaceInspection& surface, const WindingNumber& winding, const CageSettings& settings);

}  // namespace bullet_fem
