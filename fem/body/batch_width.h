// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

namespace bullet_fem
{

/// Maximum number of bodies of one model in a batch: one AVX-512 vector of floats, two of AVX2, four of SSE or NEON.
constexpr int kBatchWidth = 16;

/// One value per body.
template <int kBodies>
struct PerBody
{
    double m[kBodies] = {};

    double& operator[](int body) { return m[body]; }
    double operator[](int body) const { return m[body]; }
};

/// One value, or one 3-vector, per body of a batch.
using PerBatch = PerBody<kBatchWidth>;
using PerBatch3 = std::array<PerBatch, 3>;

}  // namespace bullet_fem
