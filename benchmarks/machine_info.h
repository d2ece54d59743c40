// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bullet_fem
{

/// Conditions of a measurement as names and values: processor, logical cores, load of the machine, threads used,
/// compiler, build type, versions of this project and of Bullet, commit at configuration. An unknown value reads
/// "unknown".
using MachineInfo = std::vector<std::pair<std::string, std::string>>;

/// Reads the data of this machine; `threads` [-] is the number of threads in use.
MachineInfo readMachineInfo(int threads);

/// One line per field, names padded to one width.
std::string toText(const MachineInfo& info);

}  // namespace bullet_fem
