// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/cage/cage_settings.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// The elements of a box, without its holes.
TetMesh blockOf(const SceneMesh& mesh);
/// Those of a sphere.
TetMesh ballOf(const SceneMesh& mesh);
/// Those of a cylinder.
TetMesh cylinderOf(const SceneMesh& mesh);

/// How the cage of a surface is made.
CageSettings cageOf(const SceneMesh& mesh);

}  // namespace bullet_fem
