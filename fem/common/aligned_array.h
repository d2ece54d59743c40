// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <new>

namespace bullet_fem
{

/// An array that starts at a multiple of 64 bytes, as the kernels load it.
template <class Real>
using AlignedArray = hwy::AlignedFreeUniquePtr<Real[]>;
using AlignedFloats = AlignedArray<float>;
using AlignedDoubles = AlignedArray<double>;

/// `count` numbers, not initialised; at least one, so that the array is never null. Throws std::bad_alloc.
template <class Real>
AlignedArray<Real> allocateAligned(std::size_t count)
{
    AlignedArray<Real> numbers = hwy::AllocateAligned<Real>(std::max<std::size_t>(count, 1));
    if (!numbers) throw std::bad_alloc();
    return numbers;
}
inline AlignedFloats allocateFloats(std::size_t count)
{
    return allocateAligned<float>(count);
}

}  // namespace bullet_fem
