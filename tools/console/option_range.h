// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>

namespace bullet_fem
{

/// Exit codes of all programs, beside 0.
constexpr int kDataError = 1, kUsageError = 2;
/// Of `bulletfem simulate`: a body ended inside out, or inside another.
constexpr int kFaultyEnd = 3;

/// An option must be a number in [low, high]. CLI::Range lets NaN pass.
CLI::Validator inRange(double low, double high);

}  // namespace bullet_fem
