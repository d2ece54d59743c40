// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/stiffness/stiffness_case.h"

namespace bullet_fem
{

/// Conjugate gradient iterations of the free motion, most of the first four steps, of a free bar of 12 x 2 x 2 cells
/// that is bent to an arc of 30 degrees and released. Implicit Euler.
int releaseBentBar(const StiffnessCase& of);

}  // namespace bullet_fem
