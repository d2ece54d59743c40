// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

class Transforms : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Transforms, eachWorld(), nameOfWorld);

// A body asleep on the floor is lifted by translate(): it wakes and falls back.
TEST_P(Transforms, ASleepingBodyWakesAndFalls)
{
    FemWorld world(GetParam());
    world.addPlane();
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.501)));
    cube.forceActivationState(ACTIVE_TAG);
    world.step(400);
    ASSERT_FALSE(cube.isActive());
    const double asleep = centerOf(cube).z;
    cube.translate(btVector3(0, 0, 1));
    world.step(10);
    EXPECT_TRUE(cube.isActive());
    EXPECT_NEAR(velocityOf(cube).z, -kGravity * 10 * kStep, 0.02 * kGravity);
    world.step(400);
    EXPECT_NEAR(centerOf(cube).z, asleep, 1e-3);
}

// Rotated by 90 degrees about the vertical together with its pins, the body keeps its shape.
TEST_P(Transforms, APinnedBodyTurnsWithItsPinsAndStaysAsItHung)
{
    btFemSolverInfo info;
    info.m_tolerance = btScalar(1e-6);
    FemWorld world(GetParam(), info);
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody* made = btFemHelpers::createBox(world.info(), btVector3(2, 0, 0),
                                               btVector3(1, btScalar(.25), btScalar(.25)), btScalar(0.125));
    for (int i = 0; i < made->m_nodes.size(); ++i)
        if (made->m_nodes[i].m_x.x() < btScalar(1.001)) made->setMass(i, 0);
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e7);
    material.m_massDamping = 5;
    fem.setMaterial(made, material);
    btSoftBody& beam = world.addSoft(made);
    world.step(400);
    std::vector<btVector3> expected;
    const btTransform quarter(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI), btVector3(3, 0, 1));
    for (int i = 0; i < beam.m_nodes.size(); ++i) expected.push_back(quarter * beam.m_nodes[i].m_x);
    beam.transform(quarter);
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        EXPECT_LT(fastestNode(beam), 0.01) << k;  // pins that moved there within a step would have 100 m/s
    }
    for (int i = 0; i < beam.m_nodes.size(); ++i) EXPECT_LT((beam.m_nodes[i].m_x - expected[i]).length(), 1e-4) << i;
}

TEST_P(Transforms, FullyPinnedBodyFollowsTranslations)
{
    FemWorld world(GetParam());
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    for (int i = 0; i < cube.m_nodes.size(); ++i) cube.setMass(i, 0);
    world.step(2);
    const btVector3 before = cube.m_nodes[7].m_x;
    cube.translate(btVector3(1, 2, 3));
    world.step(2);
    EXPECT_LT((cube.m_nodes[7].m_x - before - btVector3(1, 2, 3)).length(), 1e-5);
    EXPECT_EQ(fastestNode(cube), 0);
}

}  // namespace
}  // namespace bullet_fem
