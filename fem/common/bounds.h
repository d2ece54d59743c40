// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>

namespace bullet_fem
{

/// Relative slack of bounds [-]: eight times the spacing of single precision, 2^-23. The nearest float to a bound such
/// as 1e-6 may lie outside it, and so may a sum of some floats.
constexpr double kBoundSlack = 1e-6;

/// Shortest and longest time step [s].
constexpr double kShortestStep = 1e-6, kLongestStep = 1;

/// True if the value is in [low, high] or outside it by the slack; false for NaN.
inline bool isWithin(double value, double low, double high)
{
    return value >= low - kBoundSlack * std::fabs(low) && value <= high + kBoundSlack * std::fabs(high);
}

/// True if a time step [s] is one that bodies can be stepped with.
inline bool isUsableStep(double step)
{
    return isWithin(step, kShortestStep, kLongestStep);
}

}  // namespace bullet_fem
