// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/tet_mesh.h"

namespace bullet_fem
{

/// Masses that a density gives the nodes: sum of rho V_e filled_e / 4 [kg]. `filled` is one fraction an element, or
/// empty for all 1.
std::vector<double> massesOf(const TetMesh& mesh, const std::vector<double>& filled, double density);

}  // namespace bullet_fem
