// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "support/allocation_counter.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <vector>

namespace bullet_fem
{
namespace
{

// The compiler may remove a pair of allocation and release unless the pointer escapes.
void* volatile seen;

TEST(AllocationCounter, CountsEveryFormOfNew)
{
    const AllocationCounter counter;
    EXPECT_EQ(counter.count(), 0);
    const auto one = std::make_unique<int>(1);
    seen = one.get();
    EXPECT_EQ(counter.count(), 1);
    const std::unique_ptr<int[]> several(new int[100]);
    seen = several.get();
    EXPECT_EQ(counter.count(), 2);
    const std::unique_ptr<int> quiet(new (std::nothrow) int);
    seen = quiet.get();
    EXPECT_EQ(counter.count(), 3);
    struct alignas(64) Wide
    {
        char m_bytes[64];
    };
    const auto wide = std::make_unique<Wide>();
    seen = wide.get();
    EXPECT_EQ(counter.count(), 4);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(wide.get()) % 64, 0u);
}

TEST(AllocationCounter, CountsAGrowingVectorButNotOneWithRoom)
{
    std::vector<int> v(10);
    seen = v.data();
    const AllocationCounter counter;
    v.resize(5);
    v.resize(10);
    EXPECT_EQ(counter.count(), 0);
    v.resize(v.capacity() + 1);
    seen = v.data();
    EXPECT_EQ(counter.count(), 1);
}

TEST(AllocationCounter, CountsMallocAndItsRelatives)
{
    if (!AllocationCounter::countsMalloc()) GTEST_SKIP() << "a sanitizer owns malloc";
    const AllocationCounter counter;
    void* memory = std::malloc(10);
    seen = memory;
    EXPECT_EQ(counter.count(), 1);
    memory = std::realloc(memory, 100000);
    seen = memory;
    EXPECT_EQ(counter.count(), 2);
    std::free(memory);
    memory = std::calloc(10, 10);
    seen = memory;
    EXPECT_EQ(counter.count(), 3);
    EXPECT_EQ(static_cast<char*>(memory)[99], 0);
    std::free(memory);
    memory = std::aligned_alloc(32, 64);
    seen = memory;
    EXPECT_EQ(counter.count(), 4);
    std::free(memory);
    EXPECT_EQ(posix_memalign(&memory, 64, 10), 0);
    seen = memory;
    EXPECT_EQ(counter.count(), 5);
    std::free(memory);
}

TEST(AllocationCounter, StartsAtItsConstruction)
{
    const AllocationCounter outer;
    seen = std::make_unique<int>().get();
    const AllocationCounter inner;
    EXPECT_EQ(outer.count(), 1);
    EXPECT_EQ(inner.count(), 0);
}

}  // namespace
}  // namespace bullet_fem
