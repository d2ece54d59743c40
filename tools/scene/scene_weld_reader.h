// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// What the scene says of a soft body's pieces, of a mesh of this kind.
ScenePieces readPieces(const JsonCursor& at, SceneMesh::Kind mesh);

/// The tension at which a soft body splits, of a mesh of this kind.
SceneFracture readFracture(const JsonCursor& at, SceneMesh::Kind mesh);

/// A weld, whose bodies are checked by who knows their names.
SceneWeld readWeld(const JsonCursor& at);

}  // namespace bullet_fem
