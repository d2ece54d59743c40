// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Labels beyond which a surface is taken for a photograph, not for one with painted regions: those of a byte.
constexpr int kMaxSurfaceRegions = 256;
[[deprecated("kMaxSurfaceRegions")]] constexpr int kMostSurfaceRegions = kMaxSurfaceRegions;

/// Reads a triangle surface from an OFF, OBJ, STL or PLY file; other formats are refused. Polygons become triangles,
/// equal vertices are joined (STL has none shared), all meshes of the file become one. `scale` [-], > 0, multiplies
/// positions (files have no unit; this library's is the metre). Vertices are joined if their positions are exactly
/// equal; triangles that lose a corner by that, lines, points and unused vertices are dropped. OBJ and STL come in
/// single precision. Vertices that are painted have labels: those of a PLY file with red, green and blue 0xRRGGBB,
/// those of an OBJ file the number of the part (group, object or material) that uses them first, from 1; a file of one
/// colour or part, or of more than kMaxSurfaceRegions, has none. Throws std::runtime_error naming the file and the
/// cause: missing, unreadable, unknown ending, cut short, an index out of range, a vertex that is not finite, no
/// triangle. Throws std::invalid_argument if scale is not positive and finite.
BULLETFEM_API SurfaceMesh readSurfaceFile(const std::string& path, double scale = 1);

}  // namespace bullet_fem
