// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btMatrix3x3.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// A scene's material as the plug-in takes it.
btFemMaterial materialOf(const Material& material);

/// One whose axes turn with a body that is placed: a scene's are those of the mesh, and the plug-in's those of the rest
/// shape, which is where the body is placed.
Material turned(Material material, const btMatrix3x3& turn);

}  // namespace bullet_fem
