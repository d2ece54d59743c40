// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/contact_patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bullet_fem
{
namespace
{

constexpr double kRolledRadius = 0.1;                          // [m]
constexpr double kRolledStep = 1.0 / 60;                       // [s]
const Vec3 kFromGround = {0, 0, 1};                            // normal, from the ground to the ball
const double kBallShare = std::cbrt(4 * std::acos(-1.0) / 3);  // cube root of a ball's volume over its radius [-]

// A ball that spins about y; the velocity of its centre is along x.
ContactPatchSide ball(double spin, double velocity)
{
    return {{velocity - spin * kRolledRadius, 0, 0},
            {0, spin, 0},
            1 / kRolledRadius,
            kBallShare * kRolledRadius,
            std::nullopt};
}

ContactPatchSide ground()
{
    return {{}, {}, 0, std::numeric_limits<double>::infinity(), std::nullopt};
}

TEST(ContactPatch, OfARollingBallLagsByItsWay)
{
    const double spin = 5;
    const Vec3 lag = patchLag(ball(spin, spin * kRolledRadius), ground(), kFromGround, kRolledStep);
    EXPECT_NEAR(lag.x, -spin * kRolledRadius * kRolledStep, 1e-12);
    EXPECT_EQ(lag.z, 0);
}

// A lever of several radii, as three radians in a step give, let corrective solves diverge; constant levers gave fast
// bodies energy in every step.
TEST(ContactPatch, LagsByHalfTheSizeAtMostAndLessBeyond)
{
    constexpr double kLongStep = 0.05;                      // [s]
    const double kMost = 0.5 * kBallShare * kRolledRadius;  // [m]
    for (const double spin : {10., 17., 70., -700.})
    {
        const double way = std::abs(spin) * kRolledRadius * kLongStep;
        const double expected = way < kMost ? way : kMost * kMost / way;
        const ContactPatchSide spinning = ball(spin, spin * kRolledRadius);
        EXPECT_NEAR(norm(patchLag(spinning, ground(), kFromGround, kLongStep)), expected, 1e-12);
        EXPECT_NEAR(norm(patchLag(ground(), spinning, -kFromGround, kLongStep)), expected, 1e-12);
    }
}

}  // namespace
}  // namespace bullet_fem
