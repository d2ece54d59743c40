// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bullet_fem
{

/// What a time means nothing without, as names and values: cpu, logical cores, load of the machine, threads used,
/// compiler, build type, versions of this project and of Bullet, commit at the time of configuring. A value that is not
/// known reads "unknown".
using MachineInfo = std::vector<std::pair<std::string, std::string>>;

/// Reads the machine's; `threads` [-] is how many the program uses.
MachineInfo readMachineInfo(int threads);

/// One line a field, names padded to one width.
std::string toText(const MachineInfo& info);

}  // namespace bullet_fem
