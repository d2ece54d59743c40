// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "soak/minimise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace bullet_fem
{
namespace
{

using testing::ElementsAre;

std::vector<int> firstNumbers(int count)
{
    std::vector<int> all(static_cast<std::size_t>(count));
    std::iota(all.begin(), all.end(), 0);
    return all;
}

bool has(const std::vector<int>& all, int number)
{
    return std::find(all.begin(), all.end(), number) != all.end();
}

TEST(Minimise, KeepsNeededElements)
{
    const auto fails = [](const std::vector<int>& all) { return has(all, 3) && has(all, 200) && has(all, 201); };
    EXPECT_THAT(minimise(firstNumbers(300), fails, 10000), ElementsAre(3, 200, 201));
}

TEST(Minimise, KeepsTheOrder)
{
    const auto fails = [](const std::vector<int>& all)
    { return std::is_sorted(all.begin(), all.end()) && has(all, 0) && has(all, 9); };
    EXPECT_THAT(minimise(firstNumbers(10), fails, 1000), ElementsAre(0, 9));
}

TEST(Minimise, IsEmptyIfEverythingFails)
{
    EXPECT_TRUE(minimise(
                    firstNumbers(7), [](const std::vector<int>&) { return true; }, 1000)
                    .empty());
}

TEST(Minimise, StopsAtTheRunLimit)
{
    int runs = 0;
    const auto fails = [&runs](const std::vector<int>& all)
    {
        ++runs;
        return has(all, 5);
    };
    EXPECT_TRUE(has(minimise(firstNumbers(1000), fails, 6), 5));
    EXPECT_EQ(runs, 6);
}

}  // namespace
}  // namespace bullet_fem
