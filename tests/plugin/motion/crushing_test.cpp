// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
    double m_poisson, m_thickness, m_seconds;  // of the upper plate [m], and duration of its motion [s]
};

class Crushed : public testing::TestWithParam<std::tuple<Coupling, Press>>
{
};

constexpr double kEdge = 0.5, kPressed = 0.35;  // edge of the cube, and its height between the plates [m]

// A cube between two plates: no node penetrates by more than a hundredth of the size. The upper plate may move by half
// of its thickness within a step.
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
        double deepest = 0;  // at the start of the step
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

class Squashed : public testing::TestWithParam<Coupling>
{
};

// A column of 1 kPa falls on a plane so fast that it moves by its height in a step and a half. The nodes of its sides
// do not face downwards, but move into the plane; an earlier solver let them in by 10 cm.
TEST_P(Squashed, AColumnStaysAboveThePlane)
{
    for (const double height : {0.0735, 0.05, 0.02})
    {
        FemWorld world(WorldClass::softRigid, GetParam());
        world.addPlane();
        SoftBox box;
        box.m_size = {0.15, 0.15, 0.155};
        box.m_cells = {1, 1, 3};
        box.m_center = {0, 0, height + box.m_size.z / 2};
        box.m_youngModulus = btScalar(1e3);
        btSoftBody& column = addSoftBox(world, world.fem(), box);
        for (int i = 0; i < column.m_nodes.size(); ++i) column.m_nodes[i].m_v.setZ(btScalar(-7.5));
        double lowest = 1;
        for (int k = 0; k < 60; ++k)
        {
            world.step();
            for (int i = 0; i < column.m_nodes.size(); ++i)
                lowest = std::min(lowest, double(column.m_nodes[i].m_x.z()));
        }
        EXPECT_GT(lowest, -0.005) << "from " << height << " m";
        EXPECT_TRUE(allFinite(column));
    }
}

INSTANTIATE_TEST_SUITE_P(Couplings, Squashed, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

class PressedCube : public testing::TestWithParam<std::tuple<Coupling, double>>
{
protected:
    // Mean force of a cube on the plate in the last half second [N].
    static double force(double poisson, double friction, int frequency)
    {
        FemWorld world(WorldClass::softRigid, std::get<0>(GetParam()));
        world.addFloorBox();
        SoftBox box;
        box.m_size = {kEdge, kEdge, kEdge};
        box.m_center = {0, 0, kEdge / 2};
        box.m_friction = btScalar(friction);
        btSoftBody& cube = addSoftBox(world, world.fem(), box);
        btFemMaterial material;
        material.m_youngModulus = btScalar(kYoung);
        material.m_poissonRatio = btScalar(poisson);
        material.m_density = 1000;
        world.fem().setMaterial(&cube, material);
        btRigidBody& plate = addRigidBox(world, {2, 2, 1}, {0, at(0, 0, btScalar(kEdge + 0.5))});
        plate.setCollisionFlags(plate.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        plate.setActivationState(DISABLE_DEACTIVATION);
        double sum = 0;
        for (int k = 0; k < 3 * frequency; ++k)
        {
            const double height = std::max(kPressed, kEdge - (kEdge - kPressed) * (k + 1) / frequency);
            plate.getMotionState()->setWorldTransform(at(0, 0, btScalar(height + 0.5)));
            world.step(1, btScalar(1) / btScalar(frequency));
            if (2 * k >= 5 * frequency) sum += world.fem().contactForce(&cube, &plate).length();
        }
        return sum / (frequency / 2);
    }
    static constexpr double kYoung = 1e6;  // [Pa]
};

// Without friction its stress is that of a bar, and half of its weight does not load the plate; with friction its sides
// bulge, and the reference is the force in small steps.
TEST_P(PressedCube, PressesWithTheForceOfItsMaterial)
{
    const double poisson = std::get<1>(GetParam()), area = kEdge * kEdge;
    const double weight = 1000 * area * kEdge * kGravity;
    EXPECT_NEAR(force(poisson, 0, 60) / (kYoung * area * (1 - kPressed / kEdge) - weight / 2), 1, 1e-3);
    EXPECT_NEAR(force(poisson, 0.5, 60) / force(poisson, 0.5, 480), 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Rubber, PressedCube,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(0.3, 0.45, 0.49)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) + "_" +
                                    std::to_string(std::lround(100 * std::get<1>(suite.param)));
                         });

class Overloaded : public testing::TestWithParam<std::tuple<Coupling, double, double>>
{
};

// Under a load whose weight would strain it by more than 1 a soft cube is crushed. Flags report steps that start with a
// node deep in the ground; inner nodes get there by inverted elements. A cube that can bear the load, until this tips
// over, stays on the ground, as in steps of 1/480 s.
TEST_P(Overloaded, ReportsACrushedCube)
{
    const auto& [coupling, size, ratio] = GetParam();
    FemWorld world(WorldClass::softRigid, coupling);
    world.addFloorBox();
    SoftBox box;
    box.m_size = {size, size, size};
    box.m_center = {0, 0, size / 2};
    box.m_youngModulus = btScalar(1e5);
    btSoftBody& cube = addSoftBox(world, world.fem(), box);
    addRigidBox(world, {2 * size, 2 * size, 2 * size},
                {btScalar(ratio * massOf(cube)), at(0, 0, btScalar(2.001 * size))});
    int deep = 0, told = 0, fast = 0, toldFast = 0;
    bool wasTold = false;
    for (int k = 0; k < 120; ++k)
    {
        const bool isDeep = lowestHeight(cube) < -0.02 * size;
        world.step();
        ASSERT_TRUE(allFinite(cube));
        const int flags = world.fem().stepReport(&cube).m_flags;
        const bool tells = (flags & (BT_FEM_PENETRATING | BT_FEM_INSIDE_OUT)) != 0;
        wasTold = wasTold || tells;
        deep += isDeep;
        told += isDeep && tells;
        const bool isFast = fastestNode(cube) > 10;  // [m/s]
        fast += isFast;
        toldFast += isFast && wasTold;
    }
    const double strain = ratio * box.m_density * kGravity * size / box.m_youngModulus;
    if (strain > 1)
        EXPECT_GT(deep, 10);
    else
        EXPECT_LE(deep, 1);
    EXPECT_GE(told, 0.9 * deep);
    EXPECT_EQ(toldFast, fast);
}

INSTANTIATE_TEST_SUITE_P(Loads, Overloaded,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(0.02, 0.2, 0.5), testing::Values(100, 1000)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) + "_" +
                                    std::to_string(std::lround(1000 * std::get<1>(suite.param))) + "mm_" +
                                    std::to_string(std::lround(std::get<2>(suite.param)));
                         });

INSTANTIATE_TEST_SUITE_P(
    Presses, Crushed,
    testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                     testing::Values(Press{"slow_30", 0.3, 1, 2}, Press{"slow_49", 0.49, 1, 2},
                                     Press{"fast_49", 0.49, 1, 0.1}, Press{"thinAndFast_45", 0.45, 0.05, 0.1})),
    [](const auto& suite)
    { return std::string(couplingName(std::get<0>(suite.param))) + "_" + std::get<1>(suite.param).m_name; });

}  // namespace
}  // namespace bullet_fem
