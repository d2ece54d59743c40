// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/cage/cage_settings.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Mesh of a box without its holes.
TetMesh blockOf(const SceneMesh& mesh);
/// Mesh of a sphere.
TetMesh ballOf(const SceneMesh& mesh);
/// Mesh of a cylinder.
TetMesh cylinderOf(const SceneMesh& mesh);

/// Settings for the cage of a surface.
CageSettings cageOf(const SceneMesh& mesh);

}  // namespace bullet_fem
