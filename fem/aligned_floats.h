// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <new>

namespace bullet_fem
{

/// An array of floats that starts at a multiple of 64 bytes, as the kernels load it.
using AlignedFloats = hwy::AlignedFreeUniquePtr<float[]>;

/// `count` floats, not initialised; at least one, so that the array is never null. Throws std::bad_alloc.
inline AlignedFloats allocateFloats(std::size_t count)
{
    AlignedFloats floats = hwy::AllocateAligned<float>(std::max<std::size_t>(count, 1));
    if (!floats) throw std::bad_alloc();
    return floats;
}

}  // namespace bullet_fem
