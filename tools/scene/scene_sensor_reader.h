// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// Reads a sensor. The caller checks its name and bodies.
SceneSensor readSensor(const JsonCursor& at);

}  // namespace bullet_fem
