// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A box [0, cells] of unit cubes as a body-centred lattice, scaled by `cell` [m]: the axis between the centres of two
/// cubes is surrounded by an octahedron of four elements, that between a centre and the boundary by half of one.
TetMesh makeLatticeBox(const std::array<int, 3>& cells, double cell);

/// A mesh with inner nodes moved at random by up to `share` of a cell, and with elements in random order and node
/// order, so that its construction cannot be recognised.
TetMesh shuffledMesh(const TetMesh& mesh, double share, unsigned seed);

}  // namespace bullet_fem
