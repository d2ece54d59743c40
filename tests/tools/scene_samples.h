// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{

/// A Gmsh file of a mesh whose elements are in region 1 where y < 0.5 m, and in region -2 above.
std::string layeredMesh(const TetMesh& mesh);

/// Fills a folder with the files that the sample scenes refer to: cube.off, two.node and two.ele, regions.msh, which is
/// a layeredMesh, and body.bfem, which is baked. `folder` must be empty.
void writeSampleMeshes(const TemporaryFolder& folder);

/// A scene with each member of the format at a value that is not its default, except for mutually exclusive ones: the
/// camera has eye and target.
std::string fullScene();

/// The smallest scene with all remaining alternatives of the format: other meshes, shapes, constraints, a material by
/// its name, the camera's direction.
std::string otherScene();

}  // namespace bullet_fem
