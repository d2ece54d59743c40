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

/// What a tetrahedral mesh can be read from. docs/files.md has versions and limits.
enum class TetMeshFormat
{
    gmsh,    ///< Gmsh .msh 1 (text), 2.0 to 2.2 and 4.1 (text and binary)
    tetgen,  ///< TetGen .node and .ele; in memory the text of the one followed by that of the other
    vtk,     ///< VTK legacy .vtk 1.0 to 5.1, text and binary, DATASET UNSTRUCTURED_GRID
    vtu,     ///< VTK XML .vtu: text, base64, appended, with zlib or not
    medit    ///< Medit .mesh, text
};

/// The linear tetrahedra of a file, and what was left out.
struct TetMeshFile
{
    std::vector<Vec3> m_positions;  ///< [m] of the nodes that tetrahedra use, in the file's order
    std::vector<std::uint64_t>
        m_nodeNumbers;        ///< what the file calls each: a tag, or a count from 1 (Medit) or 0 (VTK)
    std::vector<Tet> m_tets;  ///< indices into m_positions, in the file's order and orientation
    /// What the file calls the region of every tetrahedron: a Gmsh physical group, a Medit reference, TetGen's first
    /// attribute, or the cells' array of a VTK file that docs/files.md names. Empty where it has none but 0.
    std::vector<int> m_regions;
    std::size_t m_unusedNodes = 0;    ///< left out: nodes that no tetrahedron uses
    std::size_t m_skippedFaces = 0;   ///< left out: triangles and other polygons
    std::size_t m_skippedEdges = 0;   ///< left out: lines of any order
    std::size_t m_skippedPoints = 0;  ///< left out: points given as cells
    std::string m_format;             ///< "Gmsh", "TetGen", "VTK legacy", "VTK XML" or "Medit"
    std::string m_version;            ///< as the file states it, and the encoding: "4.1 binary"; or empty
    /// Faults of the file that reading goes around, a sentence each, with its place; such as sizes that are wrong.
    std::vector<std::string> m_notes;

    /// The checked mesh. Throws std::invalid_argument on what TetMesh refuses, such as degenerate elements.
    TetMesh mesh() const { return TetMesh(m_positions, m_tets); }
};

/// Reads the tetrahedra of a file, which may be anything: it is known by its first bytes where they tell, by its ending
/// otherwise, which must be .msh, .node, .ele (each of the two brings the other, from the same folder), .vtk, .vtu or
/// .mesh. Points, lines and polygons are skipped, other cells and tetrahedra of higher order refused. `scale` [-], > 0,
/// multiplies positions (files have no unit; this library's is the metre). Memory grows with the file's size, not with
/// a count that it claims. Throws std::runtime_error naming the file, the line (text) or byte (binary, from 0), and
/// what was expected there; std::invalid_argument if scale is not positive and finite.
BULLETFEM_API TetMeshFile readTetMeshFile(const std::string& path, double scale = 1);

/// The same from memory, where `format` is what the ending tells; errors name no file. Any bytes may be given.
BULLETFEM_API TetMeshFile readTetMesh(const void* bytes, std::size_t size, TetMeshFormat format, double scale = 1);

}  // namespace bullet_fem
