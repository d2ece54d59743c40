// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rigid_history.h"

#include <gtest/gtest.h>

#include "btBulletDynamicsCommon.h"

namespace bullet_fem
{
namespace
{

constexpr double kStep = 1.0 / 60;

TEST(SortedIndex, FindsTheFirstPositionOfAKey)
{
    SortedIndex<int> index;
    index.add(7, 0);
    index.add(-1, 1);
    index.add(3, 2);
    index.add(-1, 3);
    EXPECT_EQ(index.find(7), 0);
    EXPECT_EQ(index.find(-1), 1);
    EXPECT_EQ(index.find(3), 2);
    EXPECT_EQ(index.find(4), -1);
    index.clear();
    EXPECT_EQ(index.find(7), -1);
}

class RigidHistoryTest : public ::testing::Test
{
protected:
    RigidHistoryTest()
    {
        m_body.setGravity(btVector3(0, 0, -6));
        m_body.applyGravity();
        m_history.beginStep(kStep);
        m_history.noteBeforeSolve(m_body);
    }

    double supportAfter(btScalar speed)
    {
        m_body.setLinearVelocity(btVector3(0, 0, speed));
        return m_history.supportOf(m_body, kStep, RigidProxy(), false).m_linear.z;
    }

    btSphereShape m_sphere{1};
    btRigidBody m_body{btRigidBody::btRigidBodyConstructionInfo(2, nullptr, &m_sphere, btVector3(1, 1, 1))};
    RigidHistory m_history;
};

TEST_F(RigidHistoryTest, SupportBalancesGravityAndNoMore)
{
    EXPECT_NEAR(supportAfter(0), 6 * kStep, 1e-6);           // held by a floor
    EXPECT_NEAR(supportAfter(10), 6 * kStep, 1e-6);          // hit from below
    EXPECT_NEAR(supportAfter(-3 * kStep), 3 * kStep, 1e-6);  // half held
    EXPECT_NEAR(supportAfter(-6 * kStep), 0, 1e-6);          // falling
}

TEST_F(RigidHistoryTest, BodiesThatTookNoPartAreForgotten)
{
    m_history.addToVelocity(m_body, {{1, 0, 0}, {}}, true);
    m_history.beginStep(kStep);
    EXPECT_EQ(m_history.remainderOf(m_body).m_linearGiven.x, 1);
    const RigidHistory::Memory memory = m_history.memory();
    m_history.beginStep(kStep);
    EXPECT_EQ(m_history.remainderOf(m_body).m_linearGiven.x, 0);
    m_history.restore(memory);
    EXPECT_EQ(m_history.remainderOf(m_body).m_linearGiven.x, 1);
}

TEST_F(RigidHistoryTest, RewoundObjectsAreKnownInTheNextStep)
{
    m_history.noteRewound(m_body);
    EXPECT_FALSE(m_history.wasRewound(m_body));
    m_history.beginStep(kStep);
    EXPECT_TRUE(m_history.wasRewound(m_body));
    m_history.beginStep(kStep);
    EXPECT_FALSE(m_history.wasRewound(m_body));
}

}  // namespace
}  // namespace bullet_fem
