// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Initial poses of a body's copies on a grid, the first one at `first`; x varies first, then y, then z. Optional
/// random rotations are equal in all runs. Throws std::runtime_error as JsonCursor does.
std::vector<ScenePose> readCopies(const JsonCursor& at, const ScenePose& first);

}  // namespace bullet_fem
