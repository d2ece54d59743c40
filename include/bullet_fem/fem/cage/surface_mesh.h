// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A triangle soup with shared vertices, as read from a surface file. Unchecked.
struct SurfaceMesh
{
    std::vector<Vec3> m_vertices;       ///< [m]
    std::vector<Triangle> m_triangles;  ///< vertex indices
    std::vector<int> m_labels = {};     ///< region label of each vertex; empty: no labels
};

/// The enclosed volume, by the divergence theorem about the vertices' centroid [m3]; negative if inside out.
BULLETFEM_API double signedVolume(const SurfaceMesh& surface);

}  // namespace bullet_fem
