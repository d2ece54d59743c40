// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

constexpr int kLanes = 16;  ///< elements in a block: one AVX-512 vector of floats, two of AVX2, four of SSE or NEON

}  // namespace bullet_fem
