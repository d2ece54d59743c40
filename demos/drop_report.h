// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "demos/drop_figures.h"

namespace bullet_fem
{

/// Prints the final table on stdout. Returns false if the balance of momentum or energy is violated, or the plane did
/// not hold the body.
bool printReport(const DropScene& scene, const DropFigures& figures);

}  // namespace bullet_fem
