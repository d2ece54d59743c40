// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Maximum number of labels of a surface with painted regions, those of a byte; more are taken for a photographic
/// texture.
constexpr int kMaxSurfaceRegions = 256;
[[deprecated("kMaxSurfaceRegions")]] constexpr int kMostSurfaceRegions = kMaxSurfaceRegions;

/// Reads a triangle surface from an OFF, OBJ, STL or PLY file; other formats are refused. Polygons are triangulated,
/// and all meshes of the file become one. `scale` [-], > 0, multiplies positions (files have no unit; this library's is
/// the metre). Vertices with exactly equal positions are merged (STL shares none); triangles that lose a corner
/// thereby, lines, points and unused vertices are dropped. OBJ and STL are read in single precision. Painted vertices
/// have labels: in a PLY file red, green and blue as 0xRRGGBB, in an OBJ file the number of the part (group, object or
/// material) that uses them first, from 1; a file of one colour or part, or of more than kMaxSurfaceRegions, has no
/// labels. Throws std::runtime_error naming the file and the cause: missing, unreadable, unknown extension, truncated,
/// an index out of range, a vertex that is not finite, no triangle. Throws std::invalid_argument if scale is not
/// positive and finite. Allocates.
BULLETFEM_API SurfaceMesh readSurfaceFile(const std::string& path, double scale = 1);

}  // namespace bullet_fem
