// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

// What the machine can do at most on one thread, for comparison. All run on the widest vectors that the processor has,
// as the kernels do.

/// Name of that instruction set, such as "AVX3".
const char* vectorTarget();

/// Sums `count` floats, a multiple of 512, aligned to 64 bytes: the fastest way to read them once.
float readOnce(const float* values, std::size_t count);

/// Runs `rounds` of 32 independent vectors' multiply-adds in single precision; returns a value that depends on all.
float multiplyAdd(int rounds);

/// Floating-point operations of that.
double multiplyAddOperations(int rounds);

}  // namespace bullet_fem
