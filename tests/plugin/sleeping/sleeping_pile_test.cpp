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

// Soft balls that fall into a pit three balls wide, with small horizontal offsets [m].
class Pile
{
public:
    explicit Pile(double aside = 0.01) : m_aside(static_cast<btScalar>(aside))
    {
        m_world.addFloorBox();
        const double half = 0.5 * kColumns * kSpacing;
        addWalls(m_world, half, half);
    }

    // rigid: every fifth ball is rigid.
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
        double m_fastest = 0;  // maximum node speed [m/s]
        double m_sweeps = 0;
        double m_idle = 0;  // contacts without impulse, per contact with one
    };

    // Means for a pile that may not sleep.
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

// The median of some piles, because their motion depends on rounding, and one of many stays restless for long.
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

// Although a node occasionally slips off another ball, and exceeds the threshold for a step.
TEST(SleepingPile, SleepsWithinTenSeconds)
{
    Pile pile;
    pile.fill(false);
    for (int k = 0; k < 600 && pile.asleep() == 0; ++k) pile.step();
    EXPECT_EQ(pile.asleep(), pile.size());
}

// Contacts with impulses persist: losing and finding them alternately would move some node at .02 m/s. The search does
// not use the expansion of the pile in free motion: with it, it would find 1.8 contacts without impulse for each one
// with impulse.
TEST(SleepingPile, IsStillThoughItMayNotSleep)
{
    const Pile::Rest rest = medianRest(false);
    EXPECT_LT(rest.m_fastest, 0.004);  // .0008 to .002, depending on rounding
    EXPECT_LT(rest.m_idle, 1.4);
}

// The contact point of a triangle and a rigid ball does not jump while the triangle tilts: otherwise some node would
// move at .02 m/s. Contacts of rigid balls have warm starts before the first sweep; otherwise there would be several
// times as many sweeps.
TEST(SleepingPile, IsStillWithRigidBallsInIt)
{
    const Pile::Rest rest = medianRest(true);
    EXPECT_LT(rest.m_fastest, 0.0015);
    EXPECT_LT(rest.m_sweeps, 10);
}

}  // namespace
}  // namespace bullet_fem
