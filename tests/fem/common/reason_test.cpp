// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/reason.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "fem/common/attempt.h"

namespace bullet_fem
{
namespace
{

TEST(Reason, IsTheMessageOfTheException)
{
    EXPECT_EQ(reasonOf(std::runtime_error("nu is .5")), "nu is .5");
    EXPECT_EQ(reasonOf(std::runtime_error(std::string(600, 'a'))), std::string(600, 'a'));
    EXPECT_EQ(reasonOf(std::runtime_error(std::string(601, 'a'))), std::string(600, 'a') + "...");
}

TEST(Reason, SuggestsARemedyForTooLittleMemory)
{
    std::string why;
    EXPECT_FALSE(attempt(&why, [] { throw std::bad_alloc(); }));
    EXPECT_THAT(why, testing::HasSubstr("not enough memory; ask for fewer elements"));
}

}  // namespace
}  // namespace bullet_fem
