// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>

namespace bullet_fem
{

/// Exit codes of all programs besides 0.
constexpr int kDataError = 1, kUsageError = 2;
/// Exit code of `bulletfem simulate` if a body ends with inverted elements, or inside another.
constexpr int kFaultyEnd = 3;

/// Requires an option to be a number in [low, high]; CLI::Range accepts NaN.
CLI::Validator inRange(double low, double high);

}  // namespace bullet_fem
