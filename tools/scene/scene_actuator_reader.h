// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Reads an item of 'actuators' except for its body's name. Throws as JsonCursor does.
SceneActuator readActuator(const JsonCursor& at);

}  // namespace bullet_fem
