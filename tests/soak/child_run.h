// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>

#include "soak/soak_case.h"

namespace bullet_fem
{

/// Runs `run` in a child process, so that a crash is reported as a fault ("it ended by signal 11"), and so is a run of
/// more than `seconds` of processor time [s] ("it took more than 60 s of a processor"). Throws std::runtime_error if no
/// process can be created. POSIX only.
SoakOutcome runInChild(const std::function<SoakOutcome()>& run, int seconds);

}  // namespace bullet_fem
