// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>

namespace bullet_fem
{

/// Error and signal handling of all programs. Returns the result of `run`, or kDataError after an exception, with
/// "<name>: <message>" on stderr. Exceeding a limit on file size is a write error, and a program that ends by SIGHUP,
/// SIGINT or SIGTERM leaves no unfinished file.
int runProgram(const char* name, const std::function<int()>& run);

}  // namespace bullet_fem
