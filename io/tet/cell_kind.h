// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "bullet_fem/io/tet_mesh_file.h"

namespace bullet_fem
{

/// Treatment of a file's cell.
enum class CellKind
{
    empty,   ///< ignored
    point,   ///< counted
    edge,    ///< counted
    face,    ///< counted
    tet,     ///< read: a linear tetrahedron
    refused  ///< another volume cell, or an unknown type
};

/// Counts cells that are not read.
inline void countSkipped(TetMeshFile& mesh, CellKind kind, std::size_t count)
{
    if (kind == CellKind::point) mesh.m_skippedPoints += count;
    if (kind == CellKind::edge) mesh.m_skippedEdges += count;
    if (kind == CellKind::face) mesh.m_skippedFaces += count;
}

/// A region's label; values that are not 32-bit integers give 0.
inline int regionOf(double label)
{
    const bool isWhole = label >= -2147483648.0 && label <= 2147483647.0 && std::floor(label) == label;
    return isWhole ? static_cast<int>(label) : 0;
}

/// Stores the region of the tetrahedron read last.
inline void noteRegion(TetMeshFile& mesh, double label)
{
    mesh.m_regions.resize(mesh.m_tets.size(), 0);
    if (!mesh.m_regions.empty()) mesh.m_regions.back() = regionOf(label);
}

/// Name of a refused cell for messages: "a hexahedron".
inline std::string refusalOf(const std::string& cell)
{
    return cell + " cannot be read: of volume cells only tetrahedra with 4 nodes; mesh with tetrahedra of first order";
}

}  // namespace bullet_fem
