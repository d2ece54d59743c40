// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "tools/bulletfem/figures.h"
#include "tools/scene/scene_faults.h"
#include "tools/scene/scene_flags.h"

namespace bullet_fem
{

/// Adds "flags": body, flag, title, first and last time [s], steps and explanation of each.
void tellFlags(Figures& figures, const std::vector<SceneFlag>& flags);

/// Adds "faults": body, kind ("insideOut" or "inside"), elements, or other body with depth [m] and share [-], and a
/// sentence for each.
void tellFaults(Figures& figures, const std::vector<SceneFault>& faults);

}  // namespace bullet_fem
