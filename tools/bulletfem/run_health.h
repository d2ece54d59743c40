// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/bulletfem/figures.h"
#include "tools/scene/scene_faults.h"
#include "tools/scene/scene_flags.h"

namespace bullet_fem
{

/// Adds "flags": body, flag, title, first and last [s], steps and explanation of each.
void tellFlags(Figures& figures, const std::vector<SceneFlag>& flags);

/// Adds "faults": body, what ("insideOut" or "inside"), elements, or other, depth [m] and share [-], and sentence of
/// each.
void tellFaults(Figures& figures, const std::vector<SceneFault>& faults);

}  // namespace bullet_fem
