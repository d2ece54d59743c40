// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bullet_fem/io/tet_mesh_file.h"
#include "io/tet/mesh_scanner.h"
#include "io/tet/vtk_cells.h"

namespace bullet_fem
{

/// A legacy .vtk file while it is read.
struct VtkFile
{
    MeshScanner scanner;
    TetMeshFile mesh;
    VtkCells cells;
    MeshScanner cellsPlace;  // what is wrong with cells is known only when their types are
    int major = 0;           // of the version
    bool hasPoints = false, hasCells = false, hasTypes = false;
    std::uint64_t declaredTypes = 0;  // by CELL_TYPES
    std::string typesPlace;           // of CELL_TYPES
    std::string data;                 // the keyword that ended the mesh: POINT_DATA or CELL_DATA
    std::vector<double> regions;      // of the cells, if an array tells them
};

/// A keyword, of which VTK ignores the case.
std::string vtkKeyword(std::string_view word);

/// VTK's name of a type of numbers. long is what it is on 64-bit Unix; vtkIdType is written as int.
NumberType vtkNumberType(const MeshScanner& scanner, std::string_view word);

/// `count` numbers of an array; the scanner stands behind the line that announces it.
std::vector<double> readVtkDoubles(VtkFile& file, NumberType type, std::uint64_t count, const char* what);
/// The same of integers; the type may be anything but floating.
std::vector<std::int64_t> readVtkIntegers(VtkFile& file, NumberType type, std::uint64_t count, const char* what);

/// METADATA, which ends with an empty line or the file.
void skipVtkMetadata(MeshScanner& scanner);
/// FIELD: keeps the cells' regions once CELL_DATA was read.
void readVtkField(VtkFile& file);
/// Reads the cells' regions in the SCALARS and FIELD arrays of points and cells, up to the first thing of another kind.
void findVtkRegions(VtkFile& file);

}  // namespace bullet_fem
