// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

class StiffBodies : public testing::TestWithParam<std::tuple<double, double>>  // density [kg/m3], step [s]
{
};

// A light plate of 1 GPa: in a long step the ratio of stiffness to mass in A is up to 2e7, and the factor has single
// precision.
TEST_P(StiffBodies, RestWithoutABreakdown)
{
    const auto& [density, step] = GetParam();
    FemWorld world(WorldClass::softRigid);
    world.addFloorBox();
    SoftBox plate;
    plate.m_size = {0.15, 0.12, 0.06};
    plate.m_cells = {3, 2, 1};
    plate.m_center = {0.01, 0.02, 0.05};
    plate.m_youngModulus = btScalar(1e9);
    plate.m_density = btScalar(density);
    const btSoftBody& body = addSoftBox(world, world.fem(), plate);
    int broken = 0, unsolved = 0;
    for (int k = 0; k < 100; ++k)
    {
        world.step(1, btScalar(step));
        const int flags = world.fem().stepReport(&body).m_flags;
        broken += (flags & BT_FEM_BREAKDOWN) != 0;
        unsolved += (flags & BT_FEM_NOT_CONVERGED) != 0;
    }
    EXPECT_EQ(broken, 0);
    EXPECT_EQ(unsolved, 0);
    EXPECT_LT(fastestNode(body), 1e-3);
    EXPECT_NEAR(centerOf(body).z, 0.03, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Plates, StiffBodies,
                         testing::Combine(testing::Values(20.0, 60.0, 200.0, 1000.0), testing::Values(0.05, 1.0 / 60)));

}  // namespace
}  // namespace bullet_fem
