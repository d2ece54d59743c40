// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Writes a mesh as text, so that readTetMeshFile gives the same bits: Gmsh .msh (2.2), VTK legacy .vtk (2.0, which
/// Bullet's own reader takes), VTK XML .vtu, Medit .mesh, or TetGen .node and .ele, both of which are written, counted
/// from 0, as Bullet's CreateFromTetGenData needs it. `regions`, if any, has a label for every element, as
/// TetMeshFile::m_regions. Each file appears as a whole or not at all. Throws std::runtime_error naming the path if it
/// cannot be written or its ending is another, std::invalid_argument if regions are of another number.
BULLETFEM_API void writeTetMeshFile(const std::string& path, const TetMesh& mesh, const std::vector<int>& regions = {});

/// Throws what writeTetMeshFile would if it could not begin: before work whose result goes there. Nothing is left.
BULLETFEM_API void checkTetMeshOutput(const std::string& path);

}  // namespace bullet_fem
