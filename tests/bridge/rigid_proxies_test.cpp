// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rigid_proxies.h"

#include <gtest/gtest.h>

#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kObstacleStep = 1.0 / 60;

class RigidProxiesTest : public ::testing::Test
{
protected:
    btSphereShape m_sphere{1};
    btRigidBody m_body{btRigidBody::btRigidBodyConstructionInfo(2, nullptr, &m_sphere, btVector3(1, 1, 1))};
    RigidProxies m_rigidProxies;

    // A contact with an impulse on the soft body; the rigid proxy's velocity is updated as the solve does.
    ContactProblem contact(const Vec3& impulse, const Vec3& point)
    {
        ContactPoint result;
        result.m_rigidProxy = m_rigidProxies.indexOf(m_body, kObstacleStep);
        RigidProxy& rigidProxy = m_rigidProxies.rigidProxies()[result.m_rigidProxy];
        for (int c = 0; c < 3; ++c) rigidProxy.m_linearVelocity[c] -= rigidProxy.m_inverseMass[c] * impulse[c];
        rigidProxy.m_angularVelocity -= rigidProxy.m_inverseInertia * cross(point - rigidProxy.m_center, impulse);
        result.m_impulse = impulse;
        result.m_point = point;
        ContactProblem problem;
        problem.m_contacts = {result};
        return problem;
    }
};

TEST_F(RigidProxiesTest, ADynamicBodyIsSeenWithTheVelocityOfItsNextStep)
{
    m_body.setGravity(btVector3(0, 0, -6));
    m_body.setLinearVelocity(btVector3(1, 0, 0));
    const RigidProxy rigidProxy = m_rigidProxies.rigidProxies()[m_rigidProxies.indexOf(m_body, 0.5)];
    EXPECT_NEAR(rigidProxy.m_linearVelocity.z, -3, 1e-6);
    EXPECT_NEAR(rigidProxy.m_linearVelocity.x, 1, 1e-6);
    EXPECT_NEAR(rigidProxy.m_inverseMass.x, 0.5, 1e-6);
}

TEST_F(RigidProxiesTest, AnObjectHasOneObstacle)
{
    EXPECT_EQ(m_rigidProxies.indexOf(m_body, kObstacleStep), m_rigidProxies.indexOf(m_body, kObstacleStep));
    EXPECT_EQ(m_rigidProxies.rigidProxies().size(), 1u);
}

TEST_F(RigidProxiesTest, LockedAxesReceiveNoImpulse)
{
    m_body.setLinearFactor(btVector3(1, 1, 0));
    m_body.setAngularFactor(btVector3(0, 0, 1));
    m_rigidProxies.applyReactions(contact({-2, 0, -2}, {0, 1, 0}), kObstacleStep);
    EXPECT_NEAR(m_body.getLinearVelocity().x(), 1, 1e-6);
    EXPECT_EQ(m_body.getLinearVelocity().z(), 0);
    EXPECT_EQ(m_body.getAngularVelocity().x(), 0);
    EXPECT_NEAR(m_body.getAngularVelocity().z(), -2, 1e-6);
}

TEST_F(RigidProxiesTest, ImpulsesBelowTheRoundingOfFloatAddUp)
{
    m_body.setLinearVelocity(btVector3(1, 0, 0));
    const double tiny = 2e-8;  // each changes the velocity by 1e-8, a sixth of what float can add to 1
    for (int step = 0; step < 1000; ++step)
    {
        m_rigidProxies.clear();
        m_rigidProxies.applyReactions(contact({-tiny, 0, 0}, {0, 0, 0}), kObstacleStep);
    }
    EXPECT_NEAR(m_body.getLinearVelocity().x(), 1 + 1e-5, 2e-7);
}

TEST_F(RigidProxiesTest, ImpulsesWakeABody)
{
    m_body.setActivationState(ISLAND_SLEEPING);
    m_rigidProxies.applyReactions(contact({-1, 0, 0}, {0, 0, 0}), kObstacleStep);
    EXPECT_TRUE(m_body.isActive());
}

TEST_F(RigidProxiesTest, APushMovesTheBodyAndLeavesItsVelocityAlone)
{
    m_rigidProxies.indexOf(m_body, kObstacleStep);
    m_rigidProxies.rigidProxies()[0].m_pushLinear = {0, 6, 0};
    m_rigidProxies.applyReactions(ContactProblem(), kObstacleStep);
    EXPECT_NEAR(m_body.getCenterOfMassPosition().y(), 0.1, 1e-6);
    EXPECT_EQ(m_body.getLinearVelocity(), btVector3(0, 0, 0));
}

TEST_F(RigidProxiesTest, StaticAndKinematicBodiesCannotBeMoved)
{
    m_body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    m_body.setInterpolationLinearVelocity(btVector3(0, 3, 0));
    const RigidProxy rigidProxy = m_rigidProxies.rigidProxies()[m_rigidProxies.indexOf(m_body, kObstacleStep)];
    EXPECT_EQ(rigidProxy.m_inverseMass.x, 0);
    EXPECT_EQ(rigidProxy.m_linearVelocity.y, 3);
    m_rigidProxies.applyReactions(contact({5, 5, 5}, {0, 0, 0}), kObstacleStep);
    EXPECT_EQ(m_body.getLinearVelocity(), btVector3(0, 0, 0));
}

}  // namespace
}  // namespace bullet_fem
