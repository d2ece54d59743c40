// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#if defined(HWY_COMPILE_ONLY_STATIC) || defined(HWY_COMPILE_ONLY_SCALAR)
#define BULLETFEM_WITHOUT_HIGHWAYS_LIBRARY
#else
#include <hwy/aligned_allocator.h>
#endif

#include <algorithm>
#include <memory>
#include <new>

namespace bullet_fem
{

#ifdef BULLETFEM_WITHOUT_HIGHWAYS_LIBRARY
struct AlignedDelete
{
    void operator()(void* numbers) const { ::operator delete(numbers, std::align_val_t(64)); }
};
#endif

/// An array aligned to 64 bytes, as the kernels require.
template <class Real>
#ifdef BULLETFEM_WITHOUT_HIGHWAYS_LIBRARY
using AlignedArray = std::unique_ptr<Real[], AlignedDelete>;
#else
using AlignedArray = hwy::AlignedFreeUniquePtr<Real[]>;
#endif
using AlignedFloats = AlignedArray<float>;
using AlignedDoubles = AlignedArray<double>;

/// Allocates `count` numbers, not initialised; at least one, so that the array is never null. Throws std::bad_alloc.
template <class Real>
AlignedArray<Real> allocateAligned(std::size_t count)
{
    const std::size_t least = std::max<std::size_t>(count, 1);
#ifdef BULLETFEM_WITHOUT_HIGHWAYS_LIBRARY
    if (least > static_cast<std::size_t>(-1) / sizeof(Real)) throw std::bad_alloc();
    void* const bytes = ::operator new(least * sizeof(Real), std::align_val_t(64));
    return AlignedArray<Real>(static_cast<Real*>(bytes));
#else
    AlignedArray<Real> numbers = hwy::AllocateAligned<Real>(least);
    if (!numbers) throw std::bad_alloc();
    return numbers;
#endif
}
inline AlignedFloats allocateFloats(std::size_t count)
{
    return allocateAligned<float>(count);
}

}  // namespace bullet_fem
