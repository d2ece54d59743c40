// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bullet_fem/io/tet_mesh_file.h"

namespace bullet_fem
{

constexpr std::int64_t kVtkTetrahedron = 10;  ///< VTK_TETRA, by vtkCellType.h

/// The cells of an unstructured grid, in either of VTK's formats.
struct VtkCells
{
    std::vector<std::int64_t> m_ends;          ///< one past the last corner of every cell
    std::vector<std::int64_t> m_connectivity;  ///< corners of all cells, as point indices
    std::vector<std::int64_t> m_types;         ///< VTK's cell types
};

/// Appends the tetrahedra of cells whose points are those of the mesh from `firstPoint` on, and counts the others.
/// Throws std::runtime_error, naming the cell, on types that are refused and on sizes and indices out of range.
void appendVtkCells(TetMeshFile& mesh, const VtkCells& cells, std::size_t firstPoint);

/// Whether a cell array of this name holds regions: region, regions, material, MaterialIds, CellEntityIds,
/// gmsh:physical, medit:ref or attribute, in any case.
bool isVtkRegionName(std::string name);

/// Stores the regions of the tetrahedra that were appended last, from an array with one number per cell. Arrays of
/// another length are ignored.
void noteVtkRegions(TetMeshFile& mesh, const VtkCells& cells, const std::vector<double>& regions);

}  // namespace bullet_fem
