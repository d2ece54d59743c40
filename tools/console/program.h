// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>

namespace bullet_fem
{

/// What main() of every program does about errors and signals: returns what `run` returns, or kDataError where it
/// throws, after "<name>: <why>" on stderr. A limit on the size of files is an error of writing, and a program that is
/// ended by SIGHUP, SIGINT or SIGTERM leaves no unfinished file.
int runProgram(const char* name, const std::function<int()>& run);

}  // namespace bullet_fem
