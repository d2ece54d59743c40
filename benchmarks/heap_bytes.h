// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

/// Bytes in use on the heap, as counted by the allocator (sizes rounded up to its granularity). The difference before
/// and after construction is the memory of an object, with all its parts. 0 with C libraries other than glibc 2.33 or
/// later. For programs with one thread.
std::size_t heapBytes();

}  // namespace bullet_fem
