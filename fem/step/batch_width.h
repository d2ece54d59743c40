// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

namespace bullet_fem
{

/// Bodies of one model that are solved side by side: a number of each is a lane. One AVX-512 vector of floats, two of
/// AVX2, four of SSE or NEON.
constexpr int kBodyLanes = 16;

/// One number a body.
struct PerLane
{
    double m[kBodyLanes] = {};

    double& operator[](int lane) { return m[lane]; }
    double operator[](int lane) const { return m[lane]; }
};

/// A vector a body.
using PerLane3 = std::array<PerLane, 3>;

}  // namespace bullet_fem
