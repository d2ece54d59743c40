// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <string>

#include "bullet_fem/fem/mesh/material.h"
#include "tools/scene/json_cursor.h"

namespace bullet_fem
{

using SceneMaterials = std::map<std::string, Material>;  ///< by their names

/// Those that every scene has.
SceneMaterials presetMaterials();

/// That of bodies that name none.
Material defaultMaterial();

/// The one of that name; fails if there is none.
const Material& materialCalled(const JsonCursor& at, const SceneMaterials& known);

/// One in JSON, which may be like one that is known.
Material readMaterial(const JsonCursor& at, const SceneMaterials& known);

}  // namespace bullet_fem
