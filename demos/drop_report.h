// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "demos/drop_figures.h"

namespace bullet_fem
{

/// Prints the table that ends the demo on stdout. False if momentum or energy is wrong, or the plane did not hold the
/// body.
bool printReport(const DropScene& scene, const DropFigures& figures);

}  // namespace bullet_fem
