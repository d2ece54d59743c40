// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

struct Press
{
    const char* m_name;
    double m_poisson, m_thickness, m_seconds;  // of the upper plate [m], and of its way [s]
};

class Crushed : public testing::TestWithParam<std::tuple<Coupling, Press>>
{
};

constexpr double kEdge = 0.5, kPressed = 0.35;  // of the cube, and its height between the plates [m]

// A cube between two plates: no node is in one of them by more than a hundredth of its size. The upper
// one may go by half of its thickness within a step.
TEST_P(Crushed, ACubeStaysBetweenThePlates)
{
    const auto& [coupling, press] = GetParam();
    FemWorld world(WorldClass::softRigid, coupling);
    world.addFloorBox();
    SoftBox box;
    box.m_size = {kEdge, kEdge, kEdge};
    box.m_center = {0, 0, kEdge / 2};
    btSoftBody& cube = addSoftBox(world, world.fem(), box);
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e6);
    material.m_poissonRatio = btScalar(press.m_poisson);
    material.m_density = 1000;
    world.fem().setMaterial(&cube, material);
    const double half = press.m_thickness / 2;
    btRigidBody& plate = addRigidBox(world, {2, 2, 2 * half}, {0, at(0, 0, btScalar(kEdge + half))});
    plate.setCollisionFlags(plate.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    plate.setActivationState(DISABLE_DEACTIVATION);
    for (int k = 0; k < 180; ++k)
    {
        const double before = std::max(kPressed, kEdge - 0.15 * k * kStep / press.m_seconds);
        const double height = std::max(kPressed, kEdge - 0.15 * (k + 1) * kStep / press.m_seconds);
        plate.getMotionState()->setWorldTransform(at(0, 0, btScalar(height + half)));
        double deepest = 0;  // as the step begins
        for (int i = 0; i < cube.m_nodes.size(); ++i)
        {
            const double z = cube.m_nodes[i].m_x.z();
            deepest = std::max({deepest, std::min(z - before, before + press.m_thickness - z), -z});
        }
        world.step();
        ASSERT_TRUE(allFinite(cube));
        ASSERT_LT(deepest, 0.01 * kEdge) << "step " << k;
        ASSERT_FALSE(world.fem().stepReport(&cube).m_flags & BT_FEM_PENETRATING) << "step " << k;
    }
}

class Overloaded : public testing::TestWithParam<Coupling>
{
};

// Under a thousand times its weight a soft cube is squeezed to nothing, and nearly every step that begins with a node
// deep in the ground says so.
TEST_P(Overloaded, ACubeSaysThatItIsInTheGround)
{
    FemWorld world(WorldClass::softRigid, GetParam());
    world.addFloorBox();
    SoftBox box;
    box.m_size = {0.2, 0.2, 0.2};
    box.m_center = {0, 0, 0.1};
    box.m_youngModulus = btScalar(1e5);
    btSoftBody& cube = addSoftBox(world, world.fem(), box);
    addRigidBox(world, {0.4, 0.4, 0.4}, {btScalar(1000 * massOf(cube)), at(0, 0, btScalar(0.401))});
    int deep = 0, told = 0;
    for (int k = 0; k < 30; ++k)
    {
        const bool isDeep = lowestHeight(cube) < -0.02 * 0.2;
        deep += isDeep;
        world.step();
        ASSERT_TRUE(allFinite(cube));
        told += isDeep && (world.fem().stepReport(&cube).m_flags & BT_FEM_PENETRATING);
    }
    EXPECT_GT(deep, 10);
    EXPECT_GE(told, 0.8 * deep);
}

INSTANTIATE_TEST_SUITE_P(Couplings, Overloaded, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return couplingName(suite.param); });

INSTANTIATE_TEST_SUITE_P(
    Presses, Crushed,
    testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                     testing::Values(Press{"slow_30", 0.3, 1, 2}, Press{"slow_49", 0.49, 1, 2},
                                     Press{"fast_49", 0.49, 1, 0.1}, Press{"thinAndFast_45", 0.45, 0.05, 0.1})),
    [](const auto& suite)
    { return std::string(couplingName(std::get<0>(suite.param))) + "_" + std::get<1>(suite.param).m_name; });

}  // namespace
}  // namespace bullet_fem
