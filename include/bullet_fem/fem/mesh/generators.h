// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

// All generators throw std::invalid_argument naming value, range and remedy, also beyond 5e6 elements in one mesh.

/// How a hexahedral cell becomes tetrahedra.
enum class CellSplit
{
    alternatingFive,  ///< five tets, mirrored from cell to cell: locks least, the default of boxes and cages
    kuhnSix           ///< six tets around the diagonal (0,0,0)-(1,1,1) of every cell: locks when nearly incompressible
};

/// A box with its lowest corner at `origin`. size [m], each > 0; cells along x, y, z, each in [1, 1000].
/// Node (i, j, k) of the grid has index (k (ny + 1) + j)(nx + 1) + i. Throws std::invalid_argument.
BULLETFEM_API TetMesh makeBox(const Vec3& size, const std::array<int, 3>& cells, const Vec3& origin = {},
                              CellSplit split = CellSplit::alternatingFive);

/// A beam along x, clampable at x = 0: a box [0, length] x [0, width] x [0, height] with cells of about `cellSize` [m],
/// at most 1000 along an edge.
BULLETFEM_API TetMesh makeBeam(double length, double width, double height, double cellSize,
                               CellSplit split = CellSplit::alternatingFive);

/// A ball of radius [m] around the origin: a cube grid of `cells` in [2, 1000] along x, y and z, mapped to the ball.
/// Six tets a cell around diagonals that point away from the centre: no element is flat on the surface.
BULLETFEM_API TetMesh makeSphere(double radius, const std::array<int, 3>& cells);

/// The same with as many cells along all three.
BULLETFEM_API TetMesh makeSphere(double radius, int cells);

/// A cylinder around the z axis, z in [-height/2, height/2] [m]: square cross sections of `cells` (even, in [2, 1000])
/// cells a side mapped to discs, `layers` in [1, 1000] along z.
BULLETFEM_API TetMesh makeCylinder(double radius, double height, int cells, int layers);

}  // namespace bullet_fem
