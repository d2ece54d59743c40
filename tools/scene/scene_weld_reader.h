// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Reads the division of a soft body into cells; fails for unsuitable kinds of meshes.
ScenePieces readPieces(const JsonCursor& at, SceneMesh::Kind mesh);

/// Reads the tension at which a soft body splits; fails for unsuitable kinds of meshes.
SceneFracture readFracture(const JsonCursor& at, SceneMesh::Kind mesh);

/// Reads a weld. The caller checks the names of its bodies.
SceneWeld readWeld(const JsonCursor& at);

}  // namespace bullet_fem
