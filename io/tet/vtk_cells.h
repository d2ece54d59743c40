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

/// Whether a cells' array of this name tells regions: region, regions, material, MaterialIds, CellEntityIds,
/// gmsh:physical, medit:ref or attribute, in any case.
bool isVtkRegionName(std::string name);

/// Notes the regions of the tetrahedra that were appended last, of an array with a number for each of their cells.
/// Arrays of another length are not taken.
void noteVtkRegions(TetMeshFile& mesh, const VtkCells& cells, const std::vector<double>& regions);

}  // namespace bullet_fem
