// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

// Peak performance of one thread, for comparison. All functions use the widest vectors of the processor, as the kernels
// do.

/// Name of the instruction set in use, such as "AVX3".
const char* vectorTarget();

/// Sums `count` floats, a multiple of 512, aligned to 64 bytes: the fastest way of reading them once.
float readOnce(const float* values, std::size_t count);

/// Makes `rounds` multiply-adds on 32 independent vectors in single precision; the result depends on all of them.
float multiplyAdd(int rounds);

/// Floating-point operations of multiplyAdd(rounds).
double multiplyAddOperations(int rounds);

}  // namespace bullet_fem
