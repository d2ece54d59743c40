// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>

#include "tools/scene/scene_materials.h"

namespace bullet_fem
{

/// Reads an object whose members are called by region labels; values are materials or names of known ones. Throws as
/// JsonCursor does.
std::map<int, Material> readRegionMaterials(const JsonCursor& at, const SceneMaterials& known);

}  // namespace bullet_fem
