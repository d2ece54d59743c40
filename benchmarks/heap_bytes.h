// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

namespace bullet_fem
{

/// Bytes that the program holds on the heap now, as the allocator counts them (sizes rounded up to its grain). What an
/// object holds is the difference before and after it was made: nothing has to be added up by hand, and nothing is
/// forgotten. 0 with C libraries other than glibc 2.33 or later. For programs of one thread.
std::size_t heapBytes();

}  // namespace bullet_fem
