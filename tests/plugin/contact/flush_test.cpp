// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

btSoftBody& addBall(FemWorld& world, const btVector3& center)
{
    btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.1, 4));
    ball->translate(center);
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e5);
    material.m_density = 1000;
    world.fem().setMaterial(ball, material);
    return world.addSoft(ball);
}

// What graze nothing but a wall's surface, or each other's, feel impulses of rounding all the way down.
TEST(Flush, BallsThatGrazeAWallAndEachOtherLandOnTheFloor)
{
    FemWorld world(WorldClass::softRigid);
    world.addFloorBox();
    world.addRigid(new btBoxShape(btVector3(0.5, 4, 2)), {0, at(btScalar(-0.83), 0, 2)});
    std::vector<btSoftBody*> balls;
    for (int k = 0; k < 24; ++k)
        balls.push_back(
            &addBall(world, {btScalar(-0.23) + btScalar(0.2) * btScalar(k % 2), btScalar(0.3) * btScalar(k / 2 - 6),
                             btScalar(0.3) + btScalar(0.05) * btScalar(k / 2)}));
    for (int k = 0; k < 60; ++k)
    {
        world.step(1);
        for (const btSoftBody* ball : balls) ASSERT_GT(lowestHeight(*ball), -0.03) << "step " << k;
    }
}

}  // namespace
}  // namespace bullet_fem
