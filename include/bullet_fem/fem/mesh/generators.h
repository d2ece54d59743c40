// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

// All generators allocate, and throw std::invalid_argument naming value, range and remedy on bad arguments, including
// more than 5e6 elements in one mesh.

/// Subdivision of a hexahedral cell into tetrahedra.
enum class CellSplit
{
    alternatingFive,  ///< five tets, mirrored from cell to cell: locks least; the default of boxes and cages
    kuhnSix           ///< six tets around each cell's diagonal (0,0,0)-(1,1,1): locks when nearly incompressible
};

/// A box with its lowest corner at `origin` [m]. `size` [m], each > 0; `cells` along x, y, z, each in [1, 1000]. Grid
/// node (i, j, k) has index (k (ny + 1) + j)(nx + 1) + i. Throws std::invalid_argument.
BULLETFEM_API TetMesh makeBox(const Vec3& size, const std::array<int, 3>& cells, const Vec3& origin = {},
                              CellSplit split = CellSplit::alternatingFive);

/// A beam along x, to be clamped at x = 0: the box [0, length] x [0, width] x [0, height] [m] with cells of about
/// `cellSize` [m], all > 0 and at most 1000 cells along an edge. Throws std::invalid_argument.
BULLETFEM_API TetMesh makeBeam(double length, double width, double height, double cellSize,
                               CellSplit split = CellSplit::alternatingFive);

/// A ball of `radius` [m], > 0, around the origin: a grid of `cells`, each in [2, 1000], along x, y and z, mapped to
/// the ball. Cells are split into six tets around diagonals that point away from the centre, so that no element is flat
/// at the surface. Throws std::invalid_argument.
BULLETFEM_API TetMesh makeSphere(double radius, const std::array<int, 3>& cells);

/// A ball of `radius` [m], > 0, around the origin with `cells`, in [2, 1000], along each of x, y and z. Throws
/// std::invalid_argument.
BULLETFEM_API TetMesh makeSphere(double radius, int cells);

/// A cylinder around the z axis, z in [-height/2, height/2] [m]: square cross sections of `cells` x `cells` (even, in
/// [2, 1000]) mapped to discs, `layers` in [1, 1000] along z. Throws std::invalid_argument.
BULLETFEM_API TetMesh makeCylinder(double radius, double height, int cells, int layers);

}  // namespace bullet_fem
