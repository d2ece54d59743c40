// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Where the copies of a body start, of which `first` is the first one: on a grid, x first, then y, then z; turned at
/// random if they are to be, alike in every run. Throws std::runtime_error as JsonCursor does.
std::vector<ScenePose> readCopies(const JsonCursor& at, const ScenePose& first);

}  // namespace bullet_fem
