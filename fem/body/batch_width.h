// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

namespace bullet_fem
{

/// Bodies of one model that are solved in a batch, at most. One AVX-512 vector of floats, two of AVX2, four of SSE or
/// NEON.
constexpr int kBatchWidth = 16;

/// One number for each of some bodies.
template <int kBodies>
struct PerBody
{
    double m[kBodies] = {};

    double& operator[](int body) { return m[body]; }
    double operator[](int body) const { return m[body]; }
};

/// One number, or one vector, for each body of a batch.
using PerBatch = PerBody<kBatchWidth>;
using PerBatch3 = std::array<PerBatch, 3>;

}  // namespace bullet_fem
