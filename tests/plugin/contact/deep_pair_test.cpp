// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Soft cubes that a program puts more than halfway into each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

// Coupling, share of the cube that is inside [-], cells along an edge.
class DeepPair : public testing::TestWithParam<std::tuple<Coupling, double, int>>
{
};

TEST_P(DeepPair, PartsWithoutBeingThrown)
{
    constexpr double edge = 0.2;  // [m]
    const auto [coupling, share, cells] = GetParam();
    FemWorld world(WorldClass::softRigid, coupling);
    world.addPlane();
    SoftBox box;
    box.m_size = {edge, edge, edge};
    box.m_cells = {cells, cells, cells};
    box.m_center = {0, 0, edge / 2};
    box.m_youngModulus = btScalar(1e5);
    btSoftBody& first = addSoftBox(world, world.fem(), box);
    box.m_center.x = 5 * edge;
    btSoftBody& second = addSoftBox(world, world.fem(), box);
    for (btSoftBody* body : {&first, &second})
    {
        body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        body->forceActivationState(ACTIVE_TAG);
    }
    world.step(30);
    second.translate(btVector3(btScalar(edge * (1 - share) - 5 * edge), 0, 0));
    double fastest = 0;
    int flags = 0;
    for (int k = 0; k < 120; ++k)
    {
        world.step();
        fastest = std::max({fastest, fastestNode(first), fastestNode(second)});
        flags |= world.fem().stepReport(&first).m_flags;
    }
    EXPECT_GT(norm(centerOf(first) - centerOf(second)), 0.95 * edge);
    EXPECT_LT(fastest, 1.5 * std::sqrt(2 * kGravity * edge));  // one may fall off the other, and turn
    EXPECT_TRUE(flags & BT_FEM_PENETRATING);
}

INSTANTIATE_TEST_SUITE_P(Cubes, DeepPair,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(0.65, 0.75, 0.9, 1.0), testing::Values(2, 4)),
                         [](const auto& suite)
                         {
                             return std::string(couplingName(std::get<0>(suite.param))) + "_" +
                                    std::to_string(std::lround(100 * std::get<1>(suite.param))) + "percent_" +
                                    std::to_string(std::get<2>(suite.param)) + "cells";
                         });

// A rigid box that a program puts into a soft cube has no way out that contacts know: it is told in every step.
TEST(DeepRigid, IsToldInEveryStepAndNeverSleeps)
{
    for (const Coupling coupling : {Coupling::swap, Coupling::coupled})
        for (const double half : {0.03, 0.09})
        {
            SCOPED_TRACE(testing::Message() << couplingName(coupling) << ", half " << half);
            FemWorld world(WorldClass::softRigid, coupling);
            world.addPlane();
            SoftBox box;
            box.m_size = {0.2, 0.2, 0.2};
            box.m_cells = {4, 4, 4};
            box.m_center = {0, 0, 0.1};
            box.m_youngModulus = btScalar(1e5);
            btSoftBody& cube = addSoftBox(world, world.fem(), box);
            cube.forceActivationState(ACTIVE_TAG);
            world.step(30);
            RigidSettings settings;
            settings.m_mass = 2;
            settings.m_transform.setIdentity();
            settings.m_transform.setOrigin(btVector3(btScalar(0.01), 0, btScalar(0.1)));
            btRigidBody& inside =
                world.addRigid(new btBoxShape(btVector3(btScalar(half), btScalar(half), btScalar(half))), settings);
            for (int k = 0; k < 240; ++k)
            {
                world.step();
                ASSERT_LT(fastestNode(cube), 3) << k;
                if (norm(centerOf(cube) - vec3(inside.getCenterOfMassPosition())) > 0.12) break;  // it has come out
                ASSERT_TRUE(world.fem().stepReport(&cube).m_flags & BT_FEM_PENETRATING) << k;
                ASSERT_TRUE(cube.isActive()) << k;
            }
            world.deleteRigid(inside);
            world.step(240);
            EXPECT_FALSE(cube.isActive());  // and sleeps as soon as it is gone
        }
}

}  // namespace
}  // namespace bullet_fem
