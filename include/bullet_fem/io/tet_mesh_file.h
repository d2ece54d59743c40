// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// File formats of tetrahedral meshes. docs/files.md has versions and limits.
enum class TetMeshFormat
{
    gmsh,    ///< Gmsh .msh 1 (text), 2.0 to 2.2 and 4.1 (text and binary)
    tetgen,  ///< TetGen .node and .ele; in memory the texts of both files, concatenated
    vtk,     ///< VTK legacy .vtk 1.0 to 5.1, text and binary, DATASET UNSTRUCTURED_GRID
    vtu,     ///< VTK XML .vtu: text, base64 or appended, with or without zlib
    medit    ///< Medit .mesh, text
};

/// The linear tetrahedra of a file, and statistics of skipped contents.
struct TetMeshFile
{
    std::vector<Vec3> m_positions;  ///< positions of the nodes that tetrahedra use, in the file's order [m]
    /// Identifier of each node in the file: a tag, or a count from 1 (Medit) or 0 (VTK).
    std::vector<std::uint64_t> m_nodeNumbers;
    std::vector<Tet> m_tets;  ///< indices into m_positions, in the file's order and orientation
    /// Region label of every tetrahedron: a Gmsh physical group, a Medit reference, TetGen's first attribute, or the
    /// cell array of a VTK file that docs/files.md names. Empty if all are 0.
    std::vector<int> m_regions;
    std::size_t m_unusedNodes = 0;    ///< skipped: nodes that no tetrahedron uses
    std::size_t m_skippedFaces = 0;   ///< skipped: triangles and other polygons
    std::size_t m_skippedEdges = 0;   ///< skipped: lines of any order
    std::size_t m_skippedPoints = 0;  ///< skipped: points given as cells
    std::string m_format;             ///< "Gmsh", "TetGen", "VTK legacy", "VTK XML" or "Medit"
    std::string m_version;            ///< version in the file, and encoding: "4.1 binary"; or empty
    /// Tolerated faults of the file, such as wrong sizes: one sentence each, with its position.
    std::vector<std::string> m_notes;

    /// The checked mesh. Throws std::invalid_argument on what TetMesh refuses, such as degenerate elements.
    TetMesh mesh() const { return TetMesh(m_positions, m_tets); }
};

/// Reads the tetrahedra of a file with any contents. The format is recognised by the first bytes, or else by the
/// extension, which must be .msh, .node, .ele (each of the two also reads the other, from its folder), .vtk, .vtu or
/// .mesh. Points, lines and polygons are skipped; other cells and tetrahedra of higher order are refused. `scale` [-],
/// > 0, multiplies positions (files have no unit; this library's is the metre). Memory is bounded by the file's size,
/// not by counts that it claims. Throws std::runtime_error naming the file, the line (text) or byte (binary, from 0),
/// and the expected contents; std::invalid_argument if scale is not positive and finite. Allocates.
BULLETFEM_API TetMeshFile readTetMeshFile(const std::string& path, double scale = 1);

/// Reads the tetrahedra of `size` bytes in memory, of any contents, with all checks of readTetMeshFile; `format`
/// replaces the file's extension. Throws std::runtime_error naming line or byte and the expected contents;
/// std::invalid_argument if scale is not positive and finite. Allocates.
BULLETFEM_API TetMeshFile readTetMesh(const void* bytes, std::size_t size, TetMeshFormat format, double scale = 1);

}  // namespace bullet_fem
