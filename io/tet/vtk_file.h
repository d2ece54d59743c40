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

/// State for reading a legacy .vtk file.
struct VtkFile
{
    MeshScanner scanner;
    TetMeshFile mesh;
    VtkCells cells;
    MeshScanner cellsPlace;  // position of the cells, for errors that are found only when their types are read
    int major = 0;           // major version
    bool hasPoints = false, hasCells = false, hasTypes = false;
    std::uint64_t declaredTypes = 0;  // by CELL_TYPES
    std::string typesPlace;           // of CELL_TYPES
    std::string data;                 // the keyword that ended the mesh: POINT_DATA or CELL_DATA
    std::vector<double> regions;      // regions of the cells, if an array has them
};

/// A keyword; VTK ignores its case.
std::string vtkKeyword(std::string_view word);

/// VTK's name of a type of numbers. long is what it is on 64-bit Unix; vtkIdType is written as int.
NumberType vtkNumberType(const MeshScanner& scanner, std::string_view word);

/// `count` numbers of an array, after the line that declares it.
std::vector<double> readVtkDoubles(VtkFile& file, NumberType type, std::uint64_t count, const char* what);
/// `count` integers of an array, after the line that declares it; throws if the type is floating-point.
std::vector<std::int64_t> readVtkIntegers(VtkFile& file, NumberType type, std::uint64_t count, const char* what);

/// Skips METADATA, which ends with an empty line or the file.
void skipVtkMetadata(MeshScanner& scanner);
/// Reads FIELD; keeps the cells' regions after CELL_DATA.
void readVtkField(VtkFile& file);
/// Reads the cells' regions in the SCALARS and FIELD arrays of points and cells, up to the first item of another kind.
void findVtkRegions(VtkFile& file);

}  // namespace bullet_fem
