// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/vec3.h"

namespace bullet_fem
{

/// The colour of a share in [0, 1] of the highest value, from blue over cyan, green and yellow to red; values beyond
/// have the colour of the nearer end, NaN that of 0. Red, green and blue in [0, 1], as screens take them (sRGB).
Vec3 heatColour(double share);

/// The same as light (linear), which is what glTF calculates with.
Vec3 linearColour(const Vec3& screenColour);

}  // namespace bullet_fem
