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

constexpr double kSpeed = 2;  // of the ball that comes [m/s]

// Five balls in a row; the first, `away` from them [m], comes upon the others, which touch.
std::vector<btSoftBody*> addRow(FemWorld& world, double away, double y = 0)
{
    std::vector<btSoftBody*> balls;
    for (int k = 0; k < 5; ++k)
    {
        btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(.2, 6));
        ball->translate(btVector3(btScalar(k == 0 ? -.4 - away : .4 * (k - 1)), btScalar(y), 0));
        balls.push_back(&addRubber(world, ball, 1e6));
    }
    balls[0]->setVelocity(btVector3(btScalar(kSpeed), 0, 0));
    return balls;
}

// In steps of 1/1920 s the last of 1 MPa leaves with .98 of the speed; at 60 Hz without rebounds it has .44. The masses
// are equal.
TEST_P(PassedImpacts, TakeTheLastBallOfARow)
{
    constexpr double kConverged = 0.98 * kSpeed;  // [m/s]
    FemWorld world(WorldClass::softRigid, GetParam(), {0, 0, 0});
    const std::vector<btSoftBody*> balls = addRow(world, .05);
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

// Rows that Bullet solves one by one, and that are hit some steps apart.
TEST(PassedImpactsOfIslands, DoNotWaitForEachOther)
{
    const auto play = [](const std::vector<double>& ways)
    {
        FemWorld world(WorldClass::softRigid, Coupling::coupled, {0, 0, 0});
        world.bullet().getSolverInfo().m_minimumSolverBatchSize = 1;
        std::vector<btSoftBody*> balls;
        for (std::size_t row = 0; row < ways.size(); ++row)
            for (btSoftBody* ball : addRow(world, ways[row], 2.0 * double(row))) balls.push_back(ball);
        world.step(60);
        std::vector<double> speeds;
        for (const btSoftBody* ball : balls) speeds.push_back(velocityOf(*ball).x);
        return speeds;
    };
    const std::vector<double> near = play({.05}), far = play({.1}), both = play({.05, .1});
    for (std::size_t k = 0; k < both.size(); ++k)
        EXPECT_NEAR(both[k], k < near.size() ? near[k] : far[k - near.size()], 0.01 * kSpeed) << k;
}

INSTANTIATE_TEST_SUITE_P(Couplings, PassedImpacts, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

}  // namespace
}  // namespace bullet_fem
