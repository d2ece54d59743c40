// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/sleeping_world.h"

extern bool gDisableDeactivation;

namespace bullet_fem
{
namespace
{

INSTANTIATE_TEST_SUITE_P(Worlds, Sleeping, eachWorld(), nameOfWorld);

TEST_P(Sleeping, RestingBodySleepsWithinFiveSecondsAndKeepsItsContacts)
{
    btRigidBody& ground = addGround();
    btSoftBody& cube = addCube();
    sleepAll(cube);
    EXPECT_EQ(fastestNode(cube), 0);
    const std::vector<btScalar> asleep = bitsOf(cube);
    m_world.step(120);
    EXPECT_EQ(cube.getActivationState(), ISLAND_SLEEPING);
    EXPECT_EQ(bitsOf(cube), asleep);
    EXPECT_GE(m_fem.contacts(&cube).size(), 9);
    const double weight = massOf(cube) * kGravity;
    EXPECT_NEAR(m_fem.contactForce(&cube, &ground).z(), weight, 1e-3 * weight);
}

TEST_P(Sleeping, ASleepingBodyIsNotSolvedFor)
{
    addGround();
    btSoftBody& cube = addCube();
    m_world.step(10);
    EXPECT_GT(m_fem.stepReport(&cube).m_contactSweeps, 0);
    sleepAll(cube);
    const btFemStepReport& report = m_fem.stepReport(&cube);
    EXPECT_EQ(report.m_iterations + report.m_contactIterations + report.m_contactSweeps, 0);
    EXPECT_EQ(report.m_freeMotionMs, 0);
    EXPECT_EQ(report.m_contactMs, 0);
    EXPECT_GT(report.m_contacts, 0);
    EXPECT_GT(report.m_nodes, 0);
}

TEST_P(Sleeping, WokenBodyStaysInPlace)
{
    addGround();
    btSoftBody& cube = addCube();
    sleepAll(cube);
    const std::vector<Vec3> asleep = edgesOf(cube);
    const double height = lowestHeight(cube);
    cube.activate(true);
    m_world.step(60);
    EXPECT_TRUE(cube.isActive());
    EXPECT_LT(largestDifference(edgesOf(cube), asleep), 1e-4 * 0.4);
    EXPECT_NEAR(lowestHeight(cube), height, 1e-4 * 0.4);
    m_world.step(kFiveSeconds - 60);
    EXPECT_FALSE(cube.isActive());
}

// A write by the user to a body at rest.
struct Write
{
    const char* m_name;
    std::function<void(btFemSoftBodySolver&, btSoftBody&)> m_do;
};

void PrintTo(const Write& write, std::ostream* stream)
{
    *stream << write.m_name;
}

class SleepingWritten : public SleepingScene, public EachWorldWith<Write>
{
protected:
    SleepingWritten() : SleepingScene(worldClass()) {}
};

TEST_P(SleepingWritten, WakesInTheNextStep)
{
    addGround();
    btSoftBody& cube = addCube();
    sleepAll(cube);
    value().m_do(m_fem, cube);
    m_world.step();
    EXPECT_TRUE(cube.isActive());
    EXPECT_GT(m_fem.stepReport(&cube).m_freeMotionMs, 0);  // 0 for a body asleep in the step
    m_world.step(60);
    EXPECT_TRUE(cube.isActive());
}

// Also in the last step before it falls asleep.
TEST_P(SleepingWritten, StaysAwakeWhenAboutToSleep)
{
    addGround();
    btSoftBody& cube = addCube();
    for (int k = 0; k < kFiveSeconds && cube.getActivationState() != WANTS_DEACTIVATION; ++k) m_world.step();
    ASSERT_EQ(cube.getActivationState(), WANTS_DEACTIVATION);
    value().m_do(m_fem, cube);
    m_world.step();
    EXPECT_TRUE(cube.isActive());
    m_world.step(60);
    EXPECT_TRUE(cube.isActive());
}

const Write kWrites[] = {
    {"Position", [](btFemSoftBodySolver&, btSoftBody& b) { b.m_nodes[3].m_x += btVector3(0, 0, btScalar(1e-4)); }},
    {"Translation", [](btFemSoftBodySolver&, btSoftBody& b) { b.translate(btVector3(0, 0, 1)); }},
    {"NodeVelocity", [](btFemSoftBodySolver&, btSoftBody& b) { b.m_nodes[3].m_v += btVector3(0, 0, btScalar(1e-3)); }},
    {"Velocity", [](btFemSoftBodySolver&, btSoftBody& b) { b.setVelocity(btVector3(0, 0, 1)); }},
    {"NodeForce", [](btFemSoftBodySolver&, btSoftBody& b) { b.addForce(btVector3(0, 0, 1), 3); }},
    {"Force", [](btFemSoftBodySolver&, btSoftBody& b) { b.addForce(btVector3(0, 0, 10)); }},
    {"Mass", [](btFemSoftBodySolver&, btSoftBody& b) { b.setMass(3, 5); }},
    {"Pin", [](btFemSoftBodySolver&, btSoftBody& b) { b.setMass(3, 0); }},
    {"Target", [](btFemSoftBodySolver& f, btSoftBody& b) { f.setNodeTarget(&b, 3, b.m_nodes[3].m_x); }},
    {"Offset", [](btFemSoftBodySolver& f, btSoftBody& b) { f.setContactOffset(&b, btScalar(0.001)); }},
    {"Material",
     [](btFemSoftBodySolver& f, btSoftBody& b)
     {
         btFemMaterial softer;
         softer.m_youngModulus = 2e5;
         softer.m_density = 0;  // masses are kept
         f.setMaterial(&b, softer);
     }},
    {"Wind", [](btFemSoftBodySolver&, btSoftBody& b) { b.setWindVelocity(btVector3(10, 0, 0)); }},
    {"Pressure", [](btFemSoftBodySolver&, btSoftBody& b) { b.m_cfg.kPR = 100; }},
    {"Friction", [](btFemSoftBodySolver&, btSoftBody& b) { b.m_cfg.kDF = 0; }},
    {"Restitution", [](btFemSoftBodySolver&, btSoftBody& b) { b.setRestitution(btScalar(0.5)); }},
    {"Hardness", [](btFemSoftBodySolver&, btSoftBody& b) { b.m_cfg.kKHR = btScalar(0.05); }},
    {"NoContact", [](btFemSoftBodySolver&, btSoftBody& b)
     { b.setCollisionFlags(b.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE); }},
    {"Gravity",
     [](btFemSoftBodySolver&, btSoftBody& b)
     {
         b.m_worldInfo->m_gravity.setX(1);
         b.m_gravityFactor = btScalar(0.99);  // of a deformable world's force
     }},
    {"Activation", [](btFemSoftBodySolver&, btSoftBody& b) { b.activate(true); }},
};

INSTANTIATE_TEST_SUITE_P(Writes, SleepingWritten, testing::Combine(eachWorld(), testing::ValuesIn(kWrites)),
                         nameOfWorldWith([](const Write& write) { return write.m_name; }));

// A bad write is reverted, and the body does not fall asleep.
TEST_P(Sleeping, ABadWriteIsRestoredAndNotSleptOver)
{
    addGround();
    btSoftBody& cube = addCube();
    sleepAll(cube);
    cube.m_nodes[0].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
    m_world.step();
    EXPECT_TRUE(m_fem.stepReport(&cube).m_flags & BT_FEM_RESTORED);
    EXPECT_TRUE(allFinite(cube));
}

TEST_P(Sleeping, TheSameTargetAgainDoesNotWake)
{
    addGround();
    btSoftBody& cube = addCube();
    m_world.step(60);
    const btVector3 target = cube.m_nodes[0].m_x;
    for (int k = 0; k < kFiveSeconds; ++k)
    {
        m_fem.setNodeTarget(&cube, 0, target);
        m_world.step();
    }
    EXPECT_EQ(cube.getActivationState(), ISLAND_SLEEPING);
    m_fem.setNodeTarget(&cube, 0, target + btVector3(0, 0, btScalar(0.001)));
    m_world.step();
    EXPECT_TRUE(cube.isActive());
    EXPECT_NEAR(cube.m_nodes[0].m_x.z(), target.z() + 0.001, 1e-6);
}

TEST_P(Sleeping, SlowlyDrivenBodyKeepsMoving)
{
    btSoftBody& cube = addCube();
    for (int i = 0; i < cube.m_nodes.size(); ++i)
    {
        cube.setMass(i, 0);
        cube.m_nodes[i].m_v = btVector3(btScalar(0.01), 0, 0);
    }
    const double start = cube.m_nodes[0].m_x.x();
    m_world.step(2 * kFiveSeconds);
    EXPECT_NEAR(cube.m_nodes[0].m_x.x() - start, 0.1, 1e-4);
}

TEST_P(Sleeping, ForceGivenEveryStepActs)
{
    addGround();
    btSoftBody& cube = addCube();
    for (int k = 0; k < 2 * kFiveSeconds; ++k)
    {
        cube.addForce(btVector3(1, 0, 0));
        m_world.step();
    }
    EXPECT_TRUE(cube.isActive());
}

void pullFromTick(btDynamicsWorld* world, btScalar)
{
    static_cast<btSoftBody*>(world->getWorldUserInfo())->addForce(btVector3(1, 0, 0), 3);
}

TEST_P(Sleeping, ForceFromATickCallbackActs)
{
    addGround();
    btSoftBody& cube = addCube();
    m_world.bullet().setInternalTickCallback(pullFromTick, &cube);
    for (int k = 0; k < kFiveSeconds; ++k)
    {
        m_world.step();
        ASSERT_TRUE(cube.isActive()) << "step " << k;
    }
    m_world.bullet().setInternalTickCallback(nullptr);
    m_world.step(kFiveSeconds);
    EXPECT_FALSE(cube.isActive());
}

TEST_P(Sleeping, SeparateNeighboursSleepIndependently)
{
    addGround();
    btSoftBody& left = addCube(-1);
    btSoftBody& right = addCube(1);
    sleepAll(left);
    sleepAll(right);
    const std::vector<btScalar> leftAsleep = bitsOf(left);
    right.setVelocity(btVector3(0, 0, 1));
    m_world.step(10);
    EXPECT_TRUE(right.isActive());
    EXPECT_FALSE(left.isActive());
    EXPECT_EQ(bitsOf(left), leftAsleep);
}

TEST_P(Sleeping, DisabledDeactivationNeverSleeps)
{
    addGround();
    btSoftBody& cube = addCube(0, btScalar(0.01), DISABLE_DEACTIVATION);
    m_world.step(2 * kFiveSeconds);
    EXPECT_EQ(cube.getActivationState(), DISABLE_DEACTIVATION);
    EXPECT_GT(m_fem.stepReport(&cube).m_contacts, 0);
}

TEST_P(Sleeping, DisabledSimulationStaysPutUnderAnyChange)
{
    addGround();
    btSoftBody& cube = addCube();
    m_world.step(10);
    cube.forceActivationState(DISABLE_SIMULATION);
    const std::vector<btScalar> before = bitsOf(cube);
    addSphere(btScalar(0.6), 10);
    m_fem.setContactOffset(&cube, btScalar(0.001));
    m_world.step(60);
    EXPECT_EQ(cube.getActivationState(), DISABLE_SIMULATION);
    EXPECT_EQ(bitsOf(cube), before);
}

TEST_P(Sleeping, BulletsGlobalSwitchKeepsAllAwake)
{
    addGround();
    btSoftBody& cube = addCube();
    sleepAll(cube);
    gDisableDeactivation = true;
    m_world.step(kFiveSeconds);
    EXPECT_TRUE(cube.isActive());
    gDisableDeactivation = false;
    m_world.step(kFiveSeconds);
    EXPECT_FALSE(cube.isActive());
}

TEST_P(Sleeping, TheThresholdIsTheBodys)
{
    addGround();
    btSoftBody& cube = addCube();
    cube.m_sleepingThreshold = 0;
    m_world.step(2 * kFiveSeconds);
    EXPECT_TRUE(cube.isActive());
}

// Sets one node's speed above the threshold for a step, as of one that slips off an edge. The step damps most of it.
void twitch(btSoftBody& body)
{
    btSoftBody::Node* highest = &body.m_nodes[0];
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_x.z() > highest->m_x.z()) highest = &body.m_nodes[i];
    highest->m_v = btVector3(0, 0, 3);
}

TEST_P(Sleeping, ATwitchCostsLittleOfTheTimeAtRest)
{
    addGround();
    btSoftBody& cube = addCube();
    const btScalar before = restForMoreThanASecond(cube);
    twitch(cube);
    m_world.step(1);
    ASSERT_GT(fastestNode(cube), cube.m_sleepingThreshold);
    EXPECT_GT(cube.getDeactivationTime(), before - btScalar(0.1));
    EXPECT_LT(cube.getDeactivationTime(), before);
    m_world.step(75);
    EXPECT_FALSE(cube.isActive());
}

TEST_P(Sleeping, MotionCostsAllOfTheTimeAtRest)
{
    addGround();
    btSoftBody& cube = addCube();
    restForMoreThanASecond(cube);
    cube.setVelocity(btVector3(0, 0, btScalar(0.4)));
    m_world.step(1);
    EXPECT_EQ(cube.getDeactivationTime(), 0);
    m_world.step(75);
    EXPECT_TRUE(cube.isActive());
}

TEST_P(Sleeping, RepeatedlyTwitchingBodyStaysAwake)
{
    addGround();
    btSoftBody& cube = addCube();
    m_world.step(30);
    for (int k = 0; k < kFiveSeconds; ++k)
    {
        if (k % 4 == 0) twitch(cube);
        m_world.step(1);
        ASSERT_EQ(cube.getActivationState(), ACTIVE_TAG) << "step " << k;  // nor does it want to sleep
    }
}

TEST_P(Sleeping, IsRepeatableToTheBit)
{
    const auto run = [](std::vector<btScalar>& bits)
    {
        FemWorld world(GetParam());
        world.addFloorBox();
        btSoftBody* cube = btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.25)),
                                                   btVector3(0.2, 0.2, 0.2), btScalar(0.1));
        world.addSoft(cube).forceActivationState(ACTIVE_TAG);
        world.step(kFiveSeconds);
        cube->setVelocity(btVector3(1, 0, 1));
        world.step(kFiveSeconds);
        bits = bitsOf(*cube);
    };
    std::vector<btScalar> first, second;
    run(first);
    run(second);
    EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace bullet_fem
