// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Reads a scene file, JSON as defined in docs/scene.schema.json. Files named in it are relative to its folder and must
/// exist. Throws std::runtime_error with the file, the path in the document, the value found and the value expected:
/// missing file, invalid JSON (with line and column), a member that is missing, unknown, of the wrong type or out of
/// range, a duplicate or unknown name of a body.
SceneDescription readScene(const std::string& path);

/// Reads a scene from memory; files named in it are relative to `folder`. Throws as readScene does.
SceneDescription parseScene(const std::string& json, const std::string& folder);

}  // namespace bullet_fem
