// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Reads the `mesh` of a soft body; its file is relative to the folder.
SceneMesh readMesh(const JsonCursor& at, const std::string& folder);

}  // namespace bullet_fem
