// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The colour map viridis, from dark violet over teal to yellow: equal steps look equally large, also in grey and to
/// the colour-blind. `share` is in [0, 1] of the highest value; values beyond have the colour of the nearer end, NaN
/// that of 0. Red, green and blue in [0, 1], as screens take them (sRGB). By Smith and van der Walt, 2015, who
/// dedicated it to the public domain (CC0).
BULLETFEM_API Vec3 viridis(double share);

/// The same as light (linear), which is what glTF calculates with.
BULLETFEM_API Vec3 linearColour(const Vec3& screenColour);

}  // namespace bullet_fem
