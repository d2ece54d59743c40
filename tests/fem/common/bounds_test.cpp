// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bounds accept values after rounding to single precision.
#include "fem/common/bounds.h"

#include <gtest/gtest.h>

#include <limits>

namespace bullet_fem
{
namespace
{

constexpr double kRelativeSpacing = std::numeric_limits<float>::epsilon();  // of single precision

TEST(Bounds, TakeTheNearestFloat)
{
    for (const double bound : {1e-6, 1e-8, 0.1, 0.3, 0.499, 0.9, 0.99, 1e9, 1e13, -0.9, -101325.0})
    {
        EXPECT_TRUE(isWithin(static_cast<float>(bound), bound, 1e20)) << bound;
        EXPECT_TRUE(isWithin(static_cast<float>(bound), -1e20, bound)) << bound;
    }
    EXPECT_TRUE(isWithin(3 * double(.33f), 0, .99)) << "a sum of floats";
}

TEST(Bounds, AreNotWiderThanTheSlack)
{
    EXPECT_GE(kBoundSlack, 8 * kRelativeSpacing);
    EXPECT_LE(kBoundSlack, 9 * kRelativeSpacing);
    EXPECT_FALSE(isWithin(1e-6 * (1 - 2 * kBoundSlack), 1e-6, 1));
    EXPECT_FALSE(isWithin(1 + 2 * kBoundSlack, 1e-6, 1));
    EXPECT_FALSE(isWithin(-1e-300, 0, 1)) << "0 is exact in both precisions";
    EXPECT_FALSE(isWithin(std::numeric_limits<double>::quiet_NaN(), 0, 1));
    EXPECT_TRUE(isWithin(std::numeric_limits<double>::infinity(), 0, std::numeric_limits<double>::infinity()));
}

TEST(Bounds, StepsRangeFromAMicrosecondToASecond)
{
    EXPECT_EQ(kShortestStep, 1e-6);
    EXPECT_EQ(kLongestStep, 1);
    for (const double step : {1e-6, double(1e-6f), 1.0}) EXPECT_TRUE(isUsableStep(step)) << step;
    for (const double step : {0.0, 9.9e-7, 1.01, -0.1, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_FALSE(isUsableStep(step)) << step;
}

}  // namespace
}  // namespace bullet_fem
