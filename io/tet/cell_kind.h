// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>

#include "bullet_fem/io/tet_mesh_file.h"

namespace bullet_fem
{

/// What becomes of a file's cell.
enum class CellKind
{
    empty,   ///< nothing
    point,   ///< counted
    edge,    ///< counted
    face,    ///< counted
    tet,     ///< read: a linear tetrahedron
    refused  ///< another volume, or a type that is not known
};

/// Counts cells that are not read.
inline void countSkipped(TetMeshFile& mesh, CellKind kind, std::size_t count)
{
    if (kind == CellKind::point) mesh.m_skippedPoints += count;
    if (kind == CellKind::edge) mesh.m_skippedEdges += count;
    if (kind == CellKind::face) mesh.m_skippedFaces += count;
}

/// What to say of a cell that is not read: "a hexahedron".
inline std::string refusalOf(const std::string& cell)
{
    return cell + " cannot be read: of volume cells only tetrahedra with 4 nodes; mesh with tetrahedra of first order";
}

}  // namespace bullet_fem
