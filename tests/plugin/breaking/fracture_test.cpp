// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// Bodies that split along faces of their elements where tension is beyond their strength.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "plugin/breaking/fracture_scene.h"
#include "plugin/scenes/each_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kStrength = 8000;  // [Pa]
constexpr double kSection = 0.25;      // of the bar's section [m2]

class SplittingBar : public testing::TestWithParam<Coupling>
{
};

INSTANTIATE_TEST_SUITE_P(Solvers, SplittingBar, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

/// Pulls harder and harder until something splits or the force is reached; the force then [N].
double pullUntilItSplits(BarScene& scene, double largest)
{
    double force = 0;
    for (int k = 0; force < largest && scene.splits().size() == 0; ++k)
    {
        force = kStrength * kSection / 4 * (k + 1) / 60;
        scene.pull(force);
        scene.m_world.step();
    }
    return force;
}

TEST_P(SplittingBar, breaksAcrossThePullAtTheStrengthThatWasSet)
{
    for (const BarMesh mesh : {BarMesh::regular, BarMesh::shaken})
    {
        Bar bar;
        bar.m_mesh = mesh;
        bar.m_isClampedLeft = true;
        BarScene scene(bar, GetParam());
        scene.setStrength(kStrength);
        const double force = pullUntilItSplits(scene, 2 * kStrength * kSection);
        ASSERT_EQ(scene.splits().size(), 1);
        EXPECT_NEAR(force / kSection, kStrength, (mesh == BarMesh::regular ? 0.01 : 0.05) * kStrength);
        EXPECT_GT(std::fabs(double(scene.splits()[0].m_normal.x())), 0.95);
        EXPECT_GT(scene.splits()[0].m_stress, btScalar(kStrength));
        for (int k = 0; k < 60 && scene.splits()[scene.splits().size() - 1].m_parts == 1; ++k)
        {
            scene.pull(force);
            scene.m_world.step();
        }
        EXPECT_EQ(scene.splits()[scene.splits().size() - 1].m_parts, 2);
        if (mesh == BarMesh::regular)
        {
            double area = 0;
            for (int k = 0; k < scene.splits().size(); ++k) area += double(scene.splits()[k].m_area);
            EXPECT_NEAR(area, kSection, 0.02 * kSection);  // the section, and no face else
        }
        std::printf("force %g splits %d parts %d area %g faces %d\n", force, scene.splits().size(), scene.splits()[scene.splits().size() - 1].m_parts, double(scene.splits()[0].m_area), scene.splits()[0].m_faces);
    }
}

}  // namespace
}  // namespace bullet_fem
