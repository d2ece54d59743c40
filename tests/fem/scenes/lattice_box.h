// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A box [0, cells] of unit cubes in a body-centred lattice: around the axis between the middles of two cubes there are
/// four elements, an octahedron, and between a middle and the boundary half of one. Scaled by `cell` [m].
TetMesh makeLatticeBox(const std::array<int, 3>& cells, double cell);

/// A box whose inner nodes are moved at random by up to `share` of a cell, elements in random order and turned about:
/// a mesh that shows nothing of how it was made.
TetMesh shuffledMesh(const TetMesh& mesh, double share, unsigned seed);

}  // namespace bullet_fem
