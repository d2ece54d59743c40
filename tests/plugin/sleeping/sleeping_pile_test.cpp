// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr btScalar kSpacing = btScalar(0.22);  // of balls of .2 m [m]
constexpr int kColumns = 3, kLayers = 4;

// Soft balls that fall into a pit of a width of three of them, from places a little aside of each other's middle [m].
class Pile
{
public:
    explicit Pile(double aside = 0.01) : m_aside(static_cast<btScalar>(aside))
    {
        m_world.addFloorBox();
        const double half = 0.5 * kColumns * kSpacing;
        addWalls(m_world, half, half);
    }

    // `rigid`: every fifth ball is.
    void fill(bool rigid)
    {
        for (int k = 0; k < kColumns * kColumns * kLayers; ++k)
            if (rigid && k % 5 == 2)
                m_world
                    .addRigid(new btSphereShape(btScalar(0.09)),
                              {3, btTransform(btQuaternion::getIdentity(), placeOf(k))})
                    .setActivationState(DISABLE_DEACTIVATION);
            else
                addBall(k);
    }

    int size() const { return static_cast<int>(m_balls.size()); }

    void step() { m_world.step(1); }

    int asleep() const
    {
        int count = 0;
        for (const btSoftBody* ball : m_balls) count += ball->getActivationState() == ISLAND_SLEEPING;
        return count;
    }

    struct Rest  // means over a second
    {
        double m_fastest = 0;  // node of all [m/s]
        double m_sweeps = 0;
        double m_idle = 0;  // contacts that carry nothing, for each that does
    };

    // Of a pile that may not sleep.
    Rest atRest()
    {
        for (btSoftBody* ball : m_balls) ball->forceActivationState(DISABLE_DEACTIVATION);
        m_world.step(300);
        constexpr int kSteps = 60;
        Rest rest;
        for (int k = 0; k < kSteps; ++k)
        {
            m_world.step(1);
            double fastest = 0;
            for (const btSoftBody* ball : m_balls) fastest = std::max(fastest, fastestNode(*ball));
            rest.m_fastest += fastest / kSteps;
            rest.m_sweeps += double(m_world.fem().stepReport(m_balls.front()).m_contactSweeps) / kSteps;
            rest.m_idle += idleContacts() / kSteps;
        }
        return rest;
    }

private:
    btVector3 placeOf(int k) const
    {
        const int layer = k / (kColumns * kColumns);
        const btScalar aside = m_aside * btScalar(k * 7 % 5 - 2);
        return {kSpacing * btScalar(k % kColumns - 1) + aside, kSpacing * btScalar(k / kColumns % kColumns - 1) - aside,
                kSpacing * (btScalar(layer) + btScalar(0.7))};
    }

    void addBall(int k)
    {
        btSoftBody* ball = btFemHelpers::createFromTetMesh(m_world.info(), makeSphere(0.1, 4));
        ball->translate(placeOf(k));
        btFemMaterial material;
        material.m_youngModulus = btScalar(2e5);
        material.m_density = 1000;
        material.m_stiffnessDamping = btScalar(0.01);
        m_world.fem().setMaterial(ball, material);
        m_world.addSoft(ball);
        ball->forceActivationState(ACTIVE_TAG);
        m_balls.push_back(ball);
    }

    double idleContacts() const
    {
        double idle = 0, pushing = 0;
        for (const btSoftBody* ball : m_balls)
        {
            const btAlignedObjectArray<btFemContact>& contacts = m_world.fem().contacts(ball);
            for (int k = 0; k < contacts.size(); ++k) (contacts[k].m_normalImpulse > 0 ? pushing : idle) += 1;
        }
        return idle / pushing;
    }

    static btFemSolverInfo solverInfo()
    {
        btFemSolverInfo info;
        info.m_contactTolerance = btScalar(1e-2);
        return info;
    }

    btScalar m_aside;
    FemWorld m_world{WorldClass::softRigid, solverInfo()};
    std::vector<btSoftBody*> m_balls;
};

// Of some piles, because their course follows rounding, and one of many stays restless for long.
Pile::Rest medianRest(bool rigid)
{
    std::vector<double> fastest, sweeps, idle;
    for (const double aside : {0.009, 0.01, 0.011})
    {
        Pile pile(aside);
        pile.fill(rigid);
        const Pile::Rest rest = pile.atRest();
        fastest.push_back(rest.m_fastest);
        sweeps.push_back(rest.m_sweeps);
        idle.push_back(rest.m_idle);
    }
    const auto median = [](std::vector<double>& values)
    {
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    };
    return {median(fastest), median(sweeps), median(idle)};
}

// Though now and then a node slips off another ball, and is faster than the threshold for a step.
TEST(SleepingPile, SleepsWithinTenSeconds)
{
    Pile pile;
    pile.fill(false);
    for (int k = 0; k < 600 && pile.asleep() == 0; ++k) pile.step();
    EXPECT_EQ(pile.asleep(), pile.size());
}

// What carries something stays a contact: were it lost and found again from step to step, a node somewhere would move
// at .02 m/s. Nor is the pile searched as if it sprang apart in free motion: for each point that carries something, 1.8
// would be found that do not.
TEST(SleepingPile, IsStillThoughItMayNotSleep)
{
    const Pile::Rest rest = medianRest(false);
    EXPECT_LT(rest.m_fastest, 0.004);  // .0008 to .002, as rounding has it
    EXPECT_LT(rest.m_idle, 1.4);
}

// Nor does the point where a triangle touches a rigid ball jump to and fro while the triangle tilts: a node somewhere
// would move at .02 m/s. What holds rigid balls is known before the first sweep; else there would be several times as
// many.
TEST(SleepingPile, IsStillWithRigidBallsInIt)
{
    const Pile::Rest rest = medianRest(true);
    EXPECT_LT(rest.m_fastest, 0.0015);
    EXPECT_LT(rest.m_sweeps, 10);
}

}  // namespace
}  // namespace bullet_fem
