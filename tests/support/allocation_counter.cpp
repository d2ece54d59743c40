// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "support/allocation_counter.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define BULLETFEM_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BULLETFEM_SANITIZED
#endif
#if defined(__GLIBC__) && !defined(BULLETFEM_SANITIZED)
#define BULLETFEM_COUNTS_MALLOC
#endif

namespace
{

std::atomic<long> allocations{0};  // constant-initialised: malloc is called before any constructor

void countOne()
{
    allocations.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

namespace bullet_fem
{

AllocationCounter::AllocationCounter() : m_start(allocations) {}

long AllocationCounter::count() const
{
    return allocations - m_start;
}

bool AllocationCounter::countsMalloc()
{
#ifdef BULLETFEM_COUNTS_MALLOC
    return true;
#else
    return false;
#endif
}

}  // namespace bullet_fem

#ifdef BULLETFEM_COUNTS_MALLOC

// glibc's allocator under the names that it keeps for replacements. The library's operator new calls this malloc.
extern "C"
{
    void* __libc_malloc(std::size_t size);
    void* __libc_calloc(std::size_t count, std::size_t size);
    void* __libc_realloc(void* old, std::size_t size);
    void* __libc_memalign(std::size_t alignment, std::size_t size);
    void __libc_free(void* memory);

    void* malloc(std::size_t size)
    {
        countOne();
        return __libc_malloc(size);
    }
    void* calloc(std::size_t count, std::size_t size)
    {
        countOne();
        return __libc_calloc(count, size);
    }
    void* realloc(void* old, std::size_t size)
    {
        countOne();
        return __libc_realloc(old, size);
    }
    void* memalign(std::size_t alignment, std::size_t size)
    {
        countOne();
        return __libc_memalign(alignment, size);
    }
    void* aligned_alloc(std::size_t alignment, std::size_t size)
    {
        countOne();
        return __libc_memalign(alignment, size);
    }
    int posix_memalign(void** result, std::size_t alignment, std::size_t size)
    {
        countOne();
        void* memory = __libc_memalign(alignment, size);
        if (memory == nullptr) return ENOMEM;
        *result = memory;
        return 0;
    }
    void free(void* memory)
    {
        __libc_free(memory);
    }
}

#else

// All forms are replaced: a sanitizer has its own version of each, and reports memory allocated by one form and
// released by another.
namespace
{

void* allocateQuietly(std::size_t size) noexcept
{
    countOne();
    return std::malloc(size ? size : 1);
}

void* allocate(std::size_t size)
{
    if (void* memory = allocateQuietly(size)) return memory;
    throw std::bad_alloc();
}

void* allocate(std::size_t size, std::align_val_t alignment)
{
    countOne();
    const std::size_t a = static_cast<std::size_t>(alignment);
#ifdef _WIN32
    if (void* memory = _aligned_malloc(size, a)) return memory;
#else
    if (void* memory = std::aligned_alloc(a, (size + a) / a * a)) return memory;
#endif
    throw std::bad_alloc();
}

void freeAligned(void* memory)
{
#ifdef _WIN32
    _aligned_free(memory);
#else
    std::free(memory);
#endif
}

}  // namespace

// clang-format off
void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocateQuietly(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocateQuietly(size); }
void* operator new(std::size_t size, std::align_val_t alignment) { return allocate(size, alignment); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return allocate(size, alignment); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { freeAligned(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { freeAligned(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { freeAligned(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { freeAligned(memory); }
// clang-format on

#endif
