// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bullet_fem/io/tet_mesh_file.h"

namespace bullet_fem
{

/// The cells of an unstructured grid, as both of VTK's formats have them.
struct VtkCells
{
    std::vector<std::int64_t> m_ends;          ///< one past the last corner of every cell
    std::vector<std::int64_t> m_connectivity;  ///< corners of all cells, indices of points
    std::vector<std::int64_t> m_types;         ///< VTK's cell types
};

/// Appends the tetrahedra of cells whose points are those of the mesh from `firstPoint` on, and counts the others.
/// Throws std::runtime_error, naming the cell, on types that are refused and on sizes and indices out of range.
void appendVtkCells(TetMeshFile& mesh, const VtkCells& cells, std::size_t firstPoint);

}  // namespace bullet_fem
