// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btMatrix3x3.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// Converts a scene's material to the plug-in's.
btFemMaterial materialOf(const Material& material);

/// Rotates material axes with a body's pose: a scene gives them in the mesh frame, the plug-in expects them in the rest
/// shape's frame, which is that of the placed body.
Material turned(Material material, const btMatrix3x3& turn);

}  // namespace bullet_fem
