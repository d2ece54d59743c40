// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Reads a scene file, JSON as docs/scene.schema.json says. Files that it names are looked for in its folder, and must
/// exist. Throws std::runtime_error that names the file, the path in the document, what is there and what is expected:
/// no such file, not JSON (with line and column), a member that is missing, unknown, of another kind or out of range, a
/// name that is used twice or that no body has.
SceneDescription readScene(const std::string& path);

/// The same from memory; `folder` is where files are looked for.
SceneDescription parseScene(const std::string& json, const std::string& folder);

}  // namespace bullet_fem
