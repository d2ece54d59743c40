// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Impacts that bodies in contact pass on to each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

btSoftBody& addRubber(FemWorld& world, btSoftBody* body, double young)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(young);
    material.m_poissonRatio = btScalar(.3);
    material.m_density = 1000;
    material.m_stiffnessDamping = 0;
    world.fem().setMaterial(body, material);
    body->m_cfg.kDF = btScalar(.5);
    body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    return world.addSoft(body);
}

class PassedImpacts : public testing::TestWithParam<Coupling>
{
};

// A ball comes upon four that touch in a row. In steps of 1/1920 s the last of 1 MPa leaves with .98 of the speed; at
// 60 Hz without rebounds it has .44. The masses are equal.
TEST_P(PassedImpacts, TakeTheLastBallOfARow)
{
    constexpr double kSpeed = 2, kConverged = 0.98 * kSpeed;  // [m/s]
    constexpr int kBalls = 5;
    FemWorld world(WorldClass::softRigid, GetParam(), {0, 0, 0});
    std::vector<btSoftBody*> balls;
    for (int k = 0; k < kBalls; ++k)
    {
        btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(.2, 6));
        ball->translate(btVector3(btScalar(k == 0 ? -.45 : .4 * (k - 1)), 0, 0));
        balls.push_back(&addRubber(world, ball, 1e6));
    }
    balls[0]->setVelocity(btVector3(btScalar(kSpeed), 0, 0));
    double most = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        double energy = 0;
        for (const btSoftBody* ball : balls) energy += motionOf(*ball).m_energy / massOf(*ball);
        most = std::max(most, energy);
    }
    Vec3 sum, turning;
    for (const btSoftBody* ball : balls)
    {
        sum += velocityOf(*ball);
        turning += (1 / massOf(*ball)) * motionOf(*ball).m_angular;
    }
    EXPECT_NEAR(velocityOf(*balls.back()).x, kConverged, 0.1 * kConverged);
    EXPECT_LT(most, 1.001 * kSpeed * kSpeed / 2);
    EXPECT_NEAR(norm(sum - Vec3{kSpeed, 0, 0}), 0, 1e-4 * kSpeed);
    EXPECT_NEAR(norm(turning), 0, 1e-4 * kSpeed);
}

INSTANTIATE_TEST_SUITE_P(Couplings, PassedImpacts, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

}  // namespace
}  // namespace bullet_fem
