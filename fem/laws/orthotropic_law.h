// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/laws/law.h"

namespace bullet_fem
{

/// The linear law stress = C e with the constants and axes of Orthotropic, in the frame that rotates with the element.
/// Its elements take the isotropic part of C as lambda and mu, and the rest as a matrix.
Law orthotropicLaw();

}  // namespace bullet_fem
