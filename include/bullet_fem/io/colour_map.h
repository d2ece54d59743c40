// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The perceptually uniform colour map viridis, from dark violet over teal to yellow, also suited to greyscale and
/// colour blindness. `share` is in [0, 1]; values outside are clamped, NaN gives the colour of 0. Returns red, green
/// and blue in [0, 1], encoded for screens (sRGB). By Smith and van der Walt, 2015, who dedicated it to the public
/// domain (CC0).
BULLETFEM_API Vec3 viridis(double share);

/// Converts an sRGB colour, components in [0, 1], to linear components, which glTF uses.
BULLETFEM_API Vec3 linearColour(const Vec3& screenColour);

}  // namespace bullet_fem
