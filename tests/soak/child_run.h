// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>

#include "soak/soak_case.h"

namespace bullet_fem
{

/// Runs it in a process of its own, so that a crash is a fault like any other ("it ended by signal 11"), and one that
/// takes more than `seconds` of processor time [s], too ("it took more than 60 s of a processor"). Throws
/// std::runtime_error if there is no process to be had. POSIX alone.
SoakOutcome runInChild(const std::function<SoakOutcome()>& run, int seconds);

}  // namespace bullet_fem
