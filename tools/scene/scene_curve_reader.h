// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// A number, or pairs of a time [s] and a number, in any order.
SceneCurve readCurve(const JsonCursor& at, const JsonRange& range);

/// A vector, or pairs of a time [s] and a vector, in any order. Each number is in the range.
SceneVectorCurve readVectorCurve(const JsonCursor& at, const JsonRange& range);

/// Whether it is a list of pairs rather than one vector.
bool isVectorCurve(const JsonCursor& at);

}  // namespace bullet_fem
