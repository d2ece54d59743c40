// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/sleeping_world.h"

namespace bullet_fem
{
namespace
{

TEST_P(Sleeping, FallingRigidBodyWakesIt)
{
    addGround();
    btSoftBody& cube = addCube();
    sleepAll(cube);
    btRigidBody& sphere = addSphere(1, 40);
    double lowest = 0;
    bool woke = false;
    for (int k = 0; k < 60; ++k)
    {
        m_world.step();
        lowest = std::min(lowest, lowestHeight(cube));
        woke = woke || fastestNode(cube) > 0.1;
    }
    EXPECT_TRUE(woke);
    EXPECT_GT(sphere.getCenterOfMassPosition().z(), 0.3);
    // The ground supports it in the step in which it wakes: otherwise it would fall by g h^2 = 2.7 mm.
    EXPECT_GT(lowest, -1e-3 * 0.4);
}

TEST_P(Sleeping, ABodyWithARigidOneOnTopSleeps)
{
    addGround();
    btSoftBody& cube = addCube();
    btRigidBody& sphere = addSphere(btScalar(0.515), 5);
    sphere.setAngularFactor(0);
    m_world.step(3 * kFiveSeconds);
    EXPECT_FALSE(cube.isActive());
    EXPECT_FALSE(sphere.isActive());
    EXPECT_NEAR(m_fem.contactForce(&cube, &sphere).z(), -5 * kGravity, 1e-3 * 5 * kGravity);
}

TEST_P(Sleeping, APusherWakesItAndMovesIt)
{
    addGround();
    btSoftBody& cube = addCube();
    btRigidBody& pusher = addPusher(at(-1, 0, btScalar(0.2)));
    sleepAll(cube);
    for (int k = 1; k <= 60; ++k)
    {
        pusher.activate(true);
        pusher.getMotionState()->setWorldTransform(at(btScalar(-1 + k / 60.0), 0, btScalar(0.2)));
        m_world.step();
    }
    EXPECT_TRUE(cube.isActive());
    // The pusher ends at x = 0; the cube's face was at -0.2, and its back is ahead by its compressed length.
    EXPECT_GT(cube.m_nodes[cube.m_nodes.size() - 1].m_x.x(), 0.3);
}

TEST_P(Sleeping, PusherArrivingInOneStepActsInThatStep)
{
    addGround();
    btSoftBody& cube = addCube();
    btRigidBody& pusher = addPusher(at(-1, 0, btScalar(0.2)));
    sleepAll(cube);
    pusher.activate(true);
    pusher.getMotionState()->setWorldTransform(at(btScalar(-0.31), 0, btScalar(0.2)));
    m_world.step();
    EXPECT_TRUE(cube.isActive());
    EXPECT_GT(m_fem.stepReport(&cube).m_contacts, 0);
}

TEST_P(Sleeping, AStaticObjectPutBesideItWakesIt)
{
    addGround();
    btSoftBody& cube = addCube();
    sleepAll(cube);
    RigidSettings settings;
    settings.m_transform = at(btScalar(-0.299), 0, btScalar(0.2));
    m_world.addRigid(new btBoxShape(btVector3(0.1, 0.1, 0.1)), settings).forceActivationState(ISLAND_SLEEPING);
    m_world.step(2);
    EXPECT_TRUE(cube.isActive());
}

TEST_P(Sleeping, ObjectAtRestKeptAwakeByTheUserDoesNotWakeIt)
{
    addGround();
    btSoftBody& cube = addCube();
    btTransform turned = at(btScalar(-0.32), 0, btScalar(0.2));
    turned.setRotation(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)));
    addPusher(turned).forceActivationState(DISABLE_DEACTIVATION);
    sleepAll(cube);
    m_world.step(60);
    EXPECT_FALSE(cube.isActive());
}

// A body with a sphere anchored 0.9 m below it: Bullet puts them in two islands.
class SleepingHanging : public SleepingScene, public testing::Test
{
protected:
    SleepingHanging()
    {
        const btVector3 below(0, 0, 2);
        for (int i = 0; i < m_cube.m_nodes.size(); ++i)
        {
            if (m_cube.m_nodes[i].m_x.z() > 2.39) m_cube.setMass(i, 0);
            if (m_cube.m_nodes[i].m_x.distance(below) < m_cube.m_nodes[m_hook].m_x.distance(below)) m_hook = i;
        }
        m_cube.appendAnchor(m_hook, &m_sphere, m_pivot);
        m_world.step(4 * kFiveSeconds);
    }

    btSoftBody& m_cube = addCube(0, 2);
    btRigidBody& m_sphere = addSphere(1, 1);
    const btVector3 m_pivot{0, 0, 1};
    int m_hook = 0;
};

TEST_F(SleepingHanging, BothSleep)
{
    EXPECT_FALSE(m_cube.isActive());
    EXPECT_FALSE(m_sphere.isActive());
}

TEST_F(SleepingHanging, ItsMotionKeepsTheBodyAwake)
{
    m_sphere.activate();
    m_sphere.setLinearVelocity(btVector3(2, 0, 0));
    for (int k = 0; k < kFiveSeconds; ++k)
    {
        m_world.step();
        ASSERT_TRUE(m_cube.isActive()) << "step " << k;
    }
    EXPECT_LT((m_sphere.getWorldTransform() * m_pivot).distance(m_cube.m_nodes[m_hook].m_x), 0.02);
}

TEST_F(SleepingHanging, ItsRemovalWakesTheBody)
{
    m_world.deleteRigid(m_sphere);
    m_world.step();
    EXPECT_TRUE(m_cube.isActive());
}

class SleepingSupport : public SleepingScene, public testing::TestWithParam<int>
{
protected:
    // A board of 1 m on the ground, of the given mass.
    btRigidBody& addBoard(btScalar mass)
    {
        btRigidBody& board =
            m_world.addRigid(new btBoxShape(btVector3(0.5, 0.5, 0.1)), {mass, at(0, 0, btScalar(0.1))});
        board.forceActivationState(mass > 0 ? ACTIVE_TAG : ISLAND_SLEEPING);
        return board;
    }
};

// Steps until the removal, counted from the step before which it would fall asleep.
TEST_P(SleepingSupport, LetsTheBodyFallWhenRemoved)
{
    btRigidBody& board = addBoard(0);
    btSoftBody& cube = addCube(0, btScalar(0.21));
    for (int k = 0; k < kFiveSeconds && cube.getActivationState() != WANTS_DEACTIVATION; ++k) m_world.step();
    ASSERT_EQ(cube.getActivationState(), WANTS_DEACTIVATION);
    m_world.step(GetParam());
    m_world.deleteRigid(board);
    m_world.step(30);
    EXPECT_LT(lowestHeight(cube), 0.2 - 0.5 * kGravity * 0.25 * 0.8);
}

INSTANTIATE_TEST_SUITE_P(Steps, SleepingSupport, testing::Values(0, 1, 2, 100));

TEST_F(SleepingSupport, LetsTheBodyFallWhenAMovableOneIsRemoved)
{
    addGround();
    btRigidBody& board = addBoard(100);
    btSoftBody& cube = addCube(0, btScalar(0.21));
    m_world.step(60);
    // Put to sleep explicitly: without the coupled solver a body at rest on a movable one has a velocity of g h.
    board.forceActivationState(ISLAND_SLEEPING);
    cube.forceActivationState(ISLAND_SLEEPING);
    m_world.step(60);
    ASSERT_FALSE(cube.isActive());
    ASSERT_FALSE(board.isActive());
    m_world.deleteRigid(board);
    m_world.step(60);
    EXPECT_LT(lowestHeight(cube), 0.01);
}

TEST_F(SleepingSupport, CarriesTheBodyWhenReplacedInPlace)
{
    btRigidBody* board = &addBoard(0);
    btSoftBody& cube = addCube(0, btScalar(0.21));
    sleepAll(cube);
    m_world.deleteRigid(*board);
    board = &addBoard(0);
    m_world.step();
    EXPECT_TRUE(cube.isActive());
    m_world.step(60);
    EXPECT_NEAR(lowestHeight(cube), 0.2, 1e-4);
    EXPECT_GT(m_fem.contactForce(&cube, board).z(), 0);
}

TEST_F(SleepingSupport, IsFollowedWhenMovedByTheUser)
{
    btRigidBody& board = addBoard(0);
    btSoftBody& cube = addCube(0, btScalar(0.21));
    sleepAll(cube);
    board.setWorldTransform(at(0, 0, btScalar(0.05)));
    m_world.step(60);
    EXPECT_NEAR(lowestHeight(cube), 0.15, 1e-3);
}

}  // namespace
}  // namespace bullet_fem
