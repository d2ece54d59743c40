// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr btScalar kSpacing = btScalar(0.22);  // of balls of .2 m [m]
constexpr int kColumns = 3, kLayers = 4;

// Soft balls that fall into a pit of a width of three of them.
class SleepingPile : public testing::Test
{
protected:
    SleepingPile()
    {
        m_world.addFloorBox();
        const double half = 0.5 * kColumns * kSpacing;
        addWalls(m_world, half, half);
        for (int k = 0; k < kColumns * kColumns * kLayers; ++k) addBall(k);
    }

    void addBall(int k)
    {
        btSoftBody* ball = btFemHelpers::createFromTetMesh(m_world.info(), makeSphere(0.1, 4));
        const int layer = k / (kColumns * kColumns);
        const btScalar aside = btScalar(0.01) * btScalar(k * 7 % 5 - 2);
        ball->translate(btVector3(kSpacing * btScalar(k % kColumns - 1) + aside,
                                  kSpacing * btScalar(k / kColumns % kColumns - 1) - aside,
                                  kSpacing * (btScalar(layer) + btScalar(0.7))));
        btFemMaterial material;
        material.m_youngModulus = btScalar(2e5);
        material.m_density = 1000;
        material.m_stiffnessDamping = btScalar(0.01);
        m_world.fem().setMaterial(ball, material);
        m_world.addSoft(ball);
        ball->forceActivationState(ACTIVE_TAG);
        m_balls.push_back(ball);
    }

    int asleep() const
    {
        int count = 0;
        for (const btSoftBody* ball : m_balls) count += ball->getActivationState() == ISLAND_SLEEPING;
        return count;
    }

    static btFemSolverInfo solverInfo()
    {
        btFemSolverInfo info;
        info.m_contactTolerance = btScalar(1e-2);
        return info;
    }

    FemWorld m_world{WorldClass::softRigid, solverInfo()};
    std::vector<btSoftBody*> m_balls;
};

// Though now and then a node slips off another ball, and is faster than the threshold for a step.
TEST_F(SleepingPile, SleepsWithinTenSeconds)
{
    for (int k = 0; k < 600 && asleep() == 0; ++k) m_world.step(1);
    EXPECT_EQ(asleep(), static_cast<int>(m_balls.size()));
}

// What carries something stays a contact: were it lost and found again from step to step, a node somewhere would move
// at .02 m/s.
TEST_F(SleepingPile, IsStillThoughItMayNotSleep)
{
    for (btSoftBody* ball : m_balls) ball->forceActivationState(DISABLE_DEACTIVATION);
    m_world.step(300);
    constexpr int kSteps = 60;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k)
    {
        m_world.step(1);
        double fastest = 0;
        for (const btSoftBody* ball : m_balls) fastest = std::max(fastest, fastestNode(*ball));
        sum += fastest;
    }
    EXPECT_LT(sum / kSteps, 0.003);
}

}  // namespace
}  // namespace bullet_fem
