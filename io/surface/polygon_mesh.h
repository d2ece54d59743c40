// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The contents of a file before triangulation and merging of vertices: positions and polygons. Indices may be out of
/// range.
struct PolygonMesh
{
    std::vector<Vec3> m_positions;
    std::vector<int> m_labels;           ///< per position, label of its colour; empty: no labels
    std::vector<int> m_corners;          ///< vertex indices of all polygons, concatenated
    std::vector<std::size_t> m_faceEnd;  ///< one past the last corner of every polygon in m_corners

    void closeFace() { m_faceEnd.push_back(m_corners.size()); }
};

/// Each reader throws an exception whose text is the cause alone; the caller prepends the file's name. Memory is
/// bounded by the data read, not by counts in a header.

/// Reads the text of an OFF file: OFF, COFF, NOFF and STOFF in text form; comments, blank lines and colours are
/// skipped.
PolygonMesh readOff(std::string_view text);

/// Reads the bytes of a PLY file, text or binary of both byte orders; only x, y, z, the faces' corners and the
/// vertices' colours (as labels, see SurfaceMesh) are kept.
PolygonMesh readPly(std::string_view bytes);

/// Reads an OBJ or STL file through Assimp, in single precision. No other file (materials) is opened. Labels are the
/// parts of the file, counted from 1.
PolygonMesh readWithAssimp(const std::string& path);

}  // namespace bullet_fem
