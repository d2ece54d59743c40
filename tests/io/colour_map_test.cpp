// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/colour_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bullet_fem
{
namespace
{

void expectColour(double share, const Vec3& published, double tolerance)
{
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(viridis(share)[i], published[i], tolerance) << share << ", part " << i;
}

// The published colours have six digits; ours are rounded to 255ths, with linear interpolation between every fifth.
TEST(ColourMap, MatchesThePublishedMap)
{
    expectColour(0, {0.267004, 0.004874, 0.329415}, 0.5 / 255);
    expectColour(128. / 255, {0.127568, 0.566949, 0.550556}, 1. / 255);
    expectColour(1, {0.993248, 0.906157, 0.143936}, 0.5 / 255);
}

TEST(ColourMap, StopsAtTheEnds)
{
    expectColour(-3, viridis(0), 0);
    expectColour(NAN, viridis(0), 0);
    expectColour(7, viridis(1), 0);
    expectColour(INFINITY, viridis(1), 0);
}

// CIE lightness, a simpler perceptual measure than CAM02-UCS, in which the map's steps are equal.
TEST(ColourMap, GetsLighterInNearlyEqualSteps)
{
    const auto lightness = [](double share)
    {
        const Vec3 light = linearColour(viridis(share));
        return 116 * std::cbrt(0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z) - 16;
    };
    const double whole = lightness(1) - lightness(0);
    EXPECT_NEAR(whole, 76, 2);
    for (int k = 0; k < 10; ++k)
        EXPECT_NEAR(lightness(0.1 * (k + 1)) - lightness(0.1 * k), whole / 10, 0.2 * whole / 10) << k;
}

TEST(ColourMap, LinearLightFollowsTheSrgbStandard)
{
    EXPECT_NEAR(linearColour({0, 0.5, 1}).y, 0.2140, 1e-4);
    EXPECT_NEAR(linearColour({0, 0.5, 1}).z, 1, 1e-12);
}

}  // namespace
}  // namespace bullet_fem
