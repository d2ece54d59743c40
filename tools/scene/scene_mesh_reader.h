// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// The `mesh` of a soft body; its file is looked for in the folder.
SceneMesh readMesh(const JsonCursor& at, const std::string& folder);

}  // namespace bullet_fem
