// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>

#include "tools/scene/scene_materials.h"

namespace bullet_fem
{

/// The materials of an object whose members are called by the labels of regions, and are materials or the names of
/// known ones. Throws what JsonCursor throws.
std::map<int, Material> readRegionMaterials(const JsonCursor& at, const SceneMaterials& known);

}  // namespace bullet_fem
