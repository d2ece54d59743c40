// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Writes a mesh as text, from which readTetMeshFile reads equal bits: Gmsh .msh (2.2), VTK legacy .vtk (2.0, which
/// Bullet's own reader supports), VTK XML .vtu, Medit .mesh, or TetGen: both .node and .ele, counted from 0, as
/// Bullet's CreateFromTetGenData expects. `regions`: one label per element, as TetMeshFile::m_regions, or empty. Each
/// file appears as a whole or not at all. Throws std::runtime_error naming the path if it cannot be written or has
/// another extension, std::invalid_argument on a wrong number of regions.
BULLETFEM_API void writeTetMeshFile(const std::string& path, const TetMesh& mesh, const std::vector<int>& regions = {});

/// Checks before long work that writeTetMeshFile can write to `path`: throws std::runtime_error naming the path if it
/// cannot be written or has another extension. Leaves no file behind.
BULLETFEM_API void checkTetMeshOutput(const std::string& path);

}  // namespace bullet_fem
