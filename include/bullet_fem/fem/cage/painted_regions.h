// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/cage/cage_settings.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// The region of every element of a mesh in which a surface is embedded, by how its vertices are painted
/// (SurfaceMesh::m_labels). An element has the label of most of the vertices in it, of several the lowest; one without
/// vertices that of the nearest element that has some, the way measured from middle to middle through the mesh, so that
/// paint does not jump from one leg to the other. Elements of pieces without any vertex have the surface's first label.
/// Empty if the surface has no labels. `embedding`: one a vertex. Throws std::invalid_argument if labels or embedding
/// are not as many as the vertices.
BULLETFEM_API std::vector<int> paintedRegions(const TetMesh& mesh, const SurfaceMesh& surface,
                                              const std::vector<Embedding>& embedding);

}  // namespace bullet_fem
