// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/sleeping_world.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

using State = btFemTouchState;

btRigidBody& addBlock(SoftWorld& world, btScalar x)
{
    return addRigidBox(world, {0.4, 0.4, 0.4}, {0, at(x, 0, btScalar(-0.2))});
}

/// Numbers of begin, persist and end reports of a pair.
struct Count
{
    int m_began = 0, m_lasting = 0, m_ended = 0;
};

class Touches : public EachWorld
{
protected:
    const btAlignedObjectArray<btFemTouch>& of(const btSoftBody& body) const { return m_fem.touches(&body); }

    void countSteps(const btSoftBody& body, int steps, Count& count)
    {
        for (int k = 0; k < steps; ++k)
        {
            m_world.step();
            for (int t = 0; t < of(body).size(); ++t)
            {
                count.m_began += of(body)[t].m_state == State::began;
                count.m_lasting += of(body)[t].m_state == State::lasting;
                count.m_ended += of(body)[t].m_state == State::ended;
            }
        }
    }

    FemWorld m_world{GetParam()};
    btFemSoftBodySolver& m_fem = m_world.fem();
};

INSTANTIATE_TEST_SUITE_P(Worlds, Touches, eachWorld(), nameOfWorld);

TEST_P(Touches, AreNoneInFlight)
{
    btSoftBody& cube = addSmallCube(m_world, 3);
    m_world.addFloorBox();
    m_world.step(10);
    EXPECT_EQ(of(cube).size(), 0);
    EXPECT_EQ(m_fem.touches(nullptr).size(), 0);
}

TEST_P(Touches, BeginOnceAndLastForARestingBody)
{
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& cube = addSmallCube(m_world, btScalar(0.02));
    Count landing, rest;
    countSteps(cube, 120, landing);
    EXPECT_GE(landing.m_began, 1);
    EXPECT_EQ(landing.m_began - landing.m_ended, 1);
    countSteps(cube, 600, rest);
    EXPECT_EQ(rest.m_began, 0);
    EXPECT_EQ(rest.m_lasting, 600);
    EXPECT_EQ(rest.m_ended, 0);
    ASSERT_EQ(of(cube).size(), 1);
    EXPECT_EQ(of(cube)[0].m_other, &floor);
    EXPECT_EQ(of(cube)[0].m_otherId, floor.getBroadphaseHandle()->m_uniqueId);
}

TEST_P(Touches, SumTheImpulsesOfTheirPoints)
{
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& cube = addSmallCube(m_world, btScalar(0.001));
    m_world.step(240);
    ASSERT_EQ(of(cube).size(), 1);
    const btFemTouch& touch = of(cube)[0];
    EXPECT_GT(touch.m_points, 0);
    EXPECT_LE(touch.m_points, m_fem.contacts(&cube).size());
    // Points beyond the slack are left out; they carry nothing, so that the sum is that of all points, to the rounding
    // of floats.
    const Vec3 all = double(kStep) * vec3(m_fem.contactForce(&cube, &floor));
    EXPECT_LT(norm(vec3(touch.m_impulse) - all), 1e-5 * norm(all));
    EXPECT_NEAR(touch.m_normalImpulse, all.z, 1e-5 * norm(all));  // the floor is flat
    EXPECT_NEAR(touch.m_normalImpulse, massOf(cube) * kGravity * kStep, 1e-2 * massOf(cube) * kGravity * kStep);
}

TEST_P(Touches, EndOnceAndWithoutAnImpulse)
{
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& cube = addSmallCube(m_world, btScalar(0.001));
    m_world.step(60);
    cube.translate(btVector3(0, 0, 2));
    cube.setVelocity(btVector3(0, 0, 0));
    m_world.step();
    ASSERT_EQ(of(cube).size(), 1);
    EXPECT_EQ(of(cube)[0].m_other, &floor);
    EXPECT_EQ(of(cube)[0].m_state, State::ended);
    EXPECT_EQ(of(cube)[0].m_points, 0);
    EXPECT_EQ(of(cube)[0].m_impulse, btVector3(0, 0, 0));
    EXPECT_EQ(of(cube)[0].m_normalImpulse, 0);
    m_world.step();
    EXPECT_EQ(of(cube).size(), 0);
}

TEST_P(Touches, ALiftWithinTheSlackDoesNotEndThem)
{
    m_world.setSoftGravity(btVector3(0, 0, 0));
    m_world.addFloorBox();
    btSoftBody& cube = addSmallCube(m_world, btScalar(-1e-5));
    m_world.step();
    ASSERT_EQ(of(cube).size(), 1);
    const double edge = 0.1;                 // edges of the lattice are 0.1 to 0.17 m
    for (const double lift : {0.002, 0.05})  // in units of the edge
    {
        cube.translate(btVector3(0, 0, btScalar(lift * edge - lowestHeight(cube))));
        cube.setVelocity(btVector3(0, 0, 0));
        m_world.step();
        ASSERT_EQ(of(cube).size(), 1) << lift;
        EXPECT_EQ(of(cube)[0].m_normalImpulse, 0) << lift;
        EXPECT_EQ(of(cube)[0].m_state, lift < 0.01 ? State::lasting : State::ended) << lift;
    }
}

TEST_P(Touches, NearbyBodyWithoutContactHasNone)
{
    m_world.setSoftGravity(btVector3(0, 0, 0));
    m_world.addFloorBox();
    btSoftBody& cube = addSmallCube(m_world, btScalar(0.0002));
    m_world.step(5);
    EXPECT_GT(m_fem.contacts(&cube).size(), 0);  // points with gaps, which carry nothing
    EXPECT_EQ(of(cube).size(), 0);
}

TEST_P(Touches, SeveralObjectsAreDistinguished)
{
    btRigidBody &left = addBlock(m_world, btScalar(-0.2)), &right = addBlock(m_world, btScalar(0.25));
    btSoftBody& cube = addSmallCube(m_world, btScalar(0.001));
    m_world.step(60);
    ASSERT_EQ(of(cube).size(), 2);
    EXPECT_NE(of(cube)[0].m_other, of(cube)[1].m_other);
    m_world.deleteRigid(right);
    m_world.step();
    ASSERT_EQ(of(cube).size(), 2);
    const int gone = of(cube)[0].m_other == &left ? 1 : 0;
    EXPECT_EQ(of(cube)[gone].m_state, State::ended);
    EXPECT_EQ(of(cube)[1 - gone].m_state, State::lasting);
    EXPECT_EQ(of(cube)[1 - gone].m_other, &left);
}

TEST_P(Touches, ObjectAtAReusedAddressMakesANewPair)
{
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& cube = addSmallCube(m_world, btScalar(0.001));
    m_world.step(60);
    const int id = of(cube)[0].m_otherId;
    m_world.bullet().removeRigidBody(&floor);
    m_world.bullet().addRigidBody(&floor);  // gets another id, as a new object at this address would
    m_world.step();
    ASSERT_EQ(of(cube).size(), 2);
    EXPECT_EQ(of(cube)[0].m_otherId, id);
    EXPECT_EQ(of(cube)[0].m_state, State::ended);
    EXPECT_EQ(of(cube)[1].m_otherId, floor.getBroadphaseHandle()->m_uniqueId);
    EXPECT_EQ(of(cube)[1].m_state, State::began);
}

TEST_P(Touches, AgreeBetweenTwoSoftBodies)
{
    m_world.addFloorBox();
    btSoftBody &lower = addSmallCube(m_world, btScalar(0.001)), &upper = addSmallCube(m_world, btScalar(0.402));
    for (btSoftBody* body : {&lower, &upper}) body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    const auto with = [this](const btSoftBody& body, const btSoftBody& other)
    {
        btFemTouch none;
        for (int k = 0; k < of(body).size(); ++k)
            if (of(body)[k].m_other == &other) none = of(body)[k];
        return none;
    };
    int steps = 0;
    for (int k = 0; k < 120; ++k)
    {
        m_world.step();
        const btFemTouch down = with(lower, upper), up = with(upper, lower);
        EXPECT_EQ(down.m_other == nullptr, up.m_other == nullptr);
        EXPECT_EQ(down.m_state, up.m_state);
        EXPECT_EQ(down.m_points, up.m_points);
        EXPECT_LE((down.m_impulse + up.m_impulse).length(), 1e-5 * up.m_impulse.length());
        steps += up.m_other == &lower;
    }
    EXPECT_GT(steps, 90);
    m_world.deleteSoft(upper);
    m_world.step();
    const btSoftBody* gone = &upper;  // used for its address only
    ASSERT_EQ(of(lower).size(), 2);
    for (int k = 0; k < 2; ++k)
        EXPECT_EQ(of(lower)[k].m_state, of(lower)[k].m_other == gone ? State::ended : State::lasting);
}

TEST(ContactPairsInTheCoupledWorld, AreReportedToo)
{
    FemWorld world(WorldClass::softRigid, Coupling::coupled);
    btRigidBody& block = addRigidBox(world, {0.2, 0.2, 0.2}, {10, at(0, 0, btScalar(0.52))});
    btRigidBody& floor = world.addFloorBox();
    btSoftBody& cube = addSmallCube(world, btScalar(0.001));
    world.step(180);
    const btAlignedObjectArray<btFemTouch>& touches = world.fem().touches(&cube);
    ASSERT_EQ(touches.size(), 2);
    for (int k = 0; k < 2; ++k)
    {
        EXPECT_EQ(touches[k].m_state, State::lasting);
        EXPECT_EQ(touches[k].m_other, k == 0 ? static_cast<btCollisionObject*>(&floor) : &block);  // floor came first
    }
}

TEST_P(Touches, BeginAndEndAtEveryBounce)
{
    m_world.addFloorBox().setRestitution(1);
    btSoftBody& cube = addSmallCube(m_world, btScalar(0.3));
    cube.setRestitution(btScalar(0.8));
    Count count;
    countSteps(cube, 240, count);
    EXPECT_GE(count.m_ended, 1);
    EXPECT_GE(count.m_began, 2);
    EXPECT_LE(count.m_began - count.m_ended, 1);
    EXPECT_LE(count.m_began, 30);
}

class SleepingContactPairs : public SleepingScene, public testing::Test
{
};

TEST_F(SleepingContactPairs, AreKeptWithoutEvents)
{
    btRigidBody& ground = addGround();
    btSoftBody& cube = addCube();
    sleepAll(cube);
    const int points = m_fem.touches(&cube).size() ? m_fem.touches(&cube)[0].m_points : 0;
    EXPECT_GT(points, 0);
    for (int k = 0; k < 30; ++k)
    {
        m_world.step();
        ASSERT_EQ(m_fem.touches(&cube).size(), 1);
        EXPECT_EQ(m_fem.touches(&cube)[0].m_state, State::lasting);
        EXPECT_EQ(m_fem.touches(&cube)[0].m_points, points);
        EXPECT_EQ(m_fem.touches(&cube)[0].m_other, &ground);
    }
}

TEST_F(SleepingContactPairs, EndWithARemovedObject)
{
    btRigidBody& ground = addGround();
    const btCollisionObject* gone = &ground;
    btSoftBody& cube = addCube();
    sleepAll(cube);
    m_world.deleteRigid(ground);
    m_world.step();
    ASSERT_EQ(m_fem.touches(&cube).size(), 1);
    EXPECT_EQ(m_fem.touches(&cube)[0].m_state, State::ended);
    EXPECT_EQ(m_fem.touches(&cube)[0].m_other, gone);
}

}  // namespace
}  // namespace bullet_fem
