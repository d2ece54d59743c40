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

/// A folder with the files that the sample scenes name: cube.off, two.node and two.ele, regions.msh, which is a
/// layeredMesh, and body.bfem, which is baked.
/// `folder` must be empty.
void writeSampleMeshes(const TemporaryFolder& folder);

/// A scene in which every member of the format stands, each with a value that is not its default, but for those that
/// exclude each other: the camera has eye and target.
std::string fullScene();

/// The smallest scene that holds everything else that a scene can have: other meshes, shapes, constraints, a material
/// by its name, the camera's direction.
std::string otherScene();

}  // namespace bullet_fem
