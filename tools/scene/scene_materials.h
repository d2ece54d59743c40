// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <string>

#include "bullet_fem/fem/mesh/material.h"
#include "tools/scene/json_cursor.h"

namespace bullet_fem
{

using SceneMaterials = std::map<std::string, Material>;  ///< by name

/// Presets that every scene knows.
SceneMaterials presetMaterials();

/// Material of bodies that name none.
Material defaultMaterial();

/// The material with the name in `at`; throws if it is unknown.
const Material& materialCalled(const JsonCursor& at, const SceneMaterials& known);

/// Reads a material, optionally based on a known one.
Material readMaterial(const JsonCursor& at, const SceneMaterials& known);

}  // namespace bullet_fem
