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

/// Region labels of a mesh's elements from the labels of an embedded surface's vertices (SurfaceMesh::m_labels). An
/// element takes the most frequent label among the vertices in it, the lowest in a tie. An element without vertices
/// takes the label of the nearest element with some, by the length of the path through element centres, so that labels
/// do not jump between limbs. Elements of connected components without vertices take the surface's first label.
/// `embedding`: one entry per vertex. Returns one label per element, or nothing if the surface has no labels. Throws
/// std::invalid_argument if the number of labels or of embeddings is not that of the vertices. Allocates.
BULLETFEM_API std::vector<int> paintedRegions(const TetMesh& mesh, const SurfaceMesh& surface,
                                              const std::vector<Embedding>& embedding);

}  // namespace bullet_fem
