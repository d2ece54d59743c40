// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/articulated_bodies.h"

#include <gtest/gtest.h>

#include <memory>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyJointFeedback.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kStep = 1.0 / 60;

class ArticulatedBodiesTest : public ::testing::Test
{
protected:
    // A free base with four links in a bent chain: spherical, revolute, prismatic and planar joints.
    ArticulatedBodiesTest()
    {
        const btVector3 inertia(1, 2, 3), arm(btScalar(0.5), btScalar(0.1), 0);
        const btQuaternion turn(btVector3(0, 0, 1), btScalar(0.3));
        m_body.setupSpherical(0, 2, inertia, -1, turn, arm, arm);
        m_body.setupRevolute(1, 3, inertia, 0, turn, btVector3(0, 1, 0), arm, arm);
        m_body.setupPrismatic(2, 4, inertia, 1, turn, btVector3(1, 0, 0), arm, arm, false);
        m_body.setupPlanar(3, 2, inertia, 2, turn, btVector3(0, 1, 0), arm);
        m_body.finalizeMultiDof();
        m_body.setLinearDamping(0);
        m_body.setAngularDamping(0);
        const btScalar bent[4] = {btScalar(0.1), btScalar(0.2), 0, btScalar(0.9746794)};
        m_body.setJointPosMultiDof(0, bent);
        m_body.setJointPos(1, btScalar(0.7));
        m_body.setJointPos(2, btScalar(0.2));
        m_body.setBaseVel(btVector3(1, 2, 3));
        m_body.setJointVel(1, 2);
        m_body.setJointVel(3, 3);  // about the axis
        for (int k = -1; k < 4; ++k)
        {
            m_colliders.push_back(std::make_unique<btMultiBodyLinkCollider>(&m_body, k));
            m_colliders.back()->setCollisionShape(&m_shape);
            if (k < 0)
                m_body.setBaseCollider(m_colliders.back().get());
            else
                m_body.getLink(k).m_collider = m_colliders.back().get();
        }
        m_body.updateCollisionObjectWorldTransforms(m_turns, m_places);
    }

    // RigidProxy k is link k - 1.
    void addAll()
    {
        m_bodies.clear();
        m_rigidProxies.assign(m_colliders.size(), RigidProxy());
        m_now.clear();
        for (std::size_t k = 0; k < m_colliders.size(); ++k)
        {
            m_rigidProxies[k].m_center = vec3(m_colliders[k]->getWorldTransform().getOrigin());
            m_now.push_back(m_bodies.add(static_cast<int>(k), *m_colliders[k], kStep, m_rigidProxies[k]));
        }
        m_bodies.connect(m_rigidProxies, m_responses);
    }

    const RigidResponse& response(int moved, int pushed) const
    {
        return m_responses[m_rigidProxies[pushed].m_firstResponse + moved];
    }

    static double difference(const Mat3& a, const Mat3& b) { return std::sqrt(squaredNorm(a - b) / squaredNorm(b)); }

    btSphereShape m_shape{1};
    btMultiBody m_body{4, 5, btVector3(1, 1, 2), false, false};
    std::vector<std::unique_ptr<btMultiBodyLinkCollider>> m_colliders;
    btAlignedObjectArray<btQuaternion> m_turns;
    btAlignedObjectArray<btVector3> m_places;
    ArticulatedBodies m_bodies;
    std::vector<RigidProxy> m_rigidProxies;
    std::vector<RigidResponse> m_responses;
    std::vector<LinkMotion> m_now;
};

TEST_F(ArticulatedBodiesTest, LinksMoveNowAsBulletSays)
{
    addAll();
    btVector3 spin[5], velocity[5];
    m_body.compTreeLinkVelocities(spin, velocity);
    for (int k = 0; k < 5; ++k)
    {
        EXPECT_LT(norm(m_now[k].m_linear - vec3(m_body.localDirToWorld(k - 1, velocity[k]))), 1e-5) << k;
        EXPECT_LT(norm(m_now[k].m_angular - vec3(m_body.localDirToWorld(k - 1, spin[k]))), 1e-5) << k;
    }
}

TEST_F(ArticulatedBodiesTest, AllLinksMoveAsTheirResponsesSaid)
{
    const Vec3 impulse = {1, -2, 3}, angular = {0.5, 1, -1};
    for (int pushed = 0; pushed < 5; ++pushed)
    {
        addAll();
        const std::vector<LinkMotion> before = m_now;
        m_bodies.addImpulse(pushed, impulse, angular);
        m_bodies.apply(m_rigidProxies, kStep);
        const std::vector<RigidResponse> said(&response(0, pushed), &response(0, pushed) + 5);
        addAll();
        for (int k = 0; k < 5; ++k)
        {
            const Vec3 linear = said[k].m_linear * impulse + said[k].m_linearOfAngular * angular;
            const Vec3 spin = said[k].m_angularOfLinear * impulse + said[k].m_angular * angular;
            EXPECT_LT(norm(m_now[k].m_linear - before[k].m_linear - linear), 2e-5 * (1 + norm(linear)));
            EXPECT_LT(norm(m_now[k].m_angular - before[k].m_angular - spin), 2e-5 * (1 + norm(spin)));
        }
    }
}

// Maxwell-Betti reciprocity: the velocity at B by an impulse at A equals the velocity at A by that impulse at B.
TEST_F(ArticulatedBodiesTest, ResponsesAreReciprocal)
{
    addAll();
    for (int a = 0; a < 5; ++a)
        for (int b = 0; b < 5; ++b)
        {
            EXPECT_LT(difference(response(a, b).m_linear, transpose(response(b, a).m_linear)), 1e-5);
            EXPECT_LT(difference(response(a, b).m_angular, transpose(response(b, a).m_angular)), 1e-5);
            EXPECT_LT(difference(response(a, b).m_linearOfAngular, transpose(response(b, a).m_angularOfLinear)), 1e-4);
        }
}

TEST_F(ArticulatedBodiesTest, ABaseAloneIsARigidBody)
{
    btMultiBody body(0, 4, btVector3(1, 2, 3), false, false);
    body.finalizeMultiDof();
    const btQuaternion turn(btVector3(1, 0, 0), btScalar(0.5));
    body.setWorldToBaseRot(turn);
    body.setBasePos(btVector3(3, 4, 5));
    btMultiBodyLinkCollider base(&body, -1);
    body.setBaseCollider(&base);
    body.updateCollisionObjectWorldTransforms(m_turns, m_places);
    m_rigidProxies.resize(1);
    m_rigidProxies[0].m_center = {3, 4, 5};
    m_bodies.add(0, base, kStep, m_rigidProxies[0]);
    m_bodies.connect(m_rigidProxies, m_responses);
    const btMatrix3x3 toWorld(turn.inverse());
    const btMatrix3x3 inverse = toWorld.scaled(btVector3(1, btScalar(0.5), btScalar(1) / 3)) * toWorld.transpose();
    Mat3 expected;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) expected(i, j) = inverse[i][j];
    EXPECT_LT(difference(m_responses[0].m_linear, Mat3::diagonal(0.25)), 1e-6);
    EXPECT_LT(difference(m_responses[0].m_angular, expected), 1e-6);
    EXPECT_LT(squaredNorm(m_responses[0].m_linearOfAngular), 1e-12);
}

TEST_F(ArticulatedBodiesTest, ForcesActInBulletsNextStep)
{
    m_body.addBaseForce(btVector3(0, 0, -7));
    m_body.addLinkForce(2, btVector3(5, 0, -9));
    m_body.addJointTorque(1, 3);
    addAll();
    const std::vector<RigidProxy> said = m_rigidProxies;
    btAlignedObjectArray<btScalar> r;
    btAlignedObjectArray<btVector3> v;
    btAlignedObjectArray<btMatrix3x3> m;
    m_body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(btScalar(kStep), r, v, m, false, false, false);
    addAll();
    for (int k = 0; k < 5; ++k)
    {
        EXPECT_LT(norm(m_now[k].m_linear - said[k].m_linearVelocity), 1e-4) << k;
        EXPECT_LT(norm(m_now[k].m_angular - said[k].m_angularVelocity), 1e-4) << k;
    }
}

TEST_F(ArticulatedBodiesTest, JointFeedbackIsLeftToTheUser)
{
    btMultiBodyJointFeedback feedback;
    feedback.m_reactionForces.m_topVec.setValue(1, 2, 3);
    m_body.getLink(1).m_jointFeedback = &feedback;
    addAll();
    EXPECT_EQ(m_body.getLink(1).m_jointFeedback, &feedback);
    EXPECT_EQ(feedback.m_reactionForces.m_topVec, btVector3(1, 2, 3));
}

TEST_F(ArticulatedBodiesTest, OnlyDynamicLinksOfWakeableMultibodiesCanMove)
{
    EXPECT_TRUE(canMove(*m_colliders[0]) && canMove(*m_colliders[2]));
    m_body.setFixedBase(true);
    EXPECT_FALSE(canMove(*m_colliders[0]));
    EXPECT_TRUE(canMove(*m_colliders[2]));
    m_colliders[2]->setDynamicType(btCollisionObject::CF_KINEMATIC_OBJECT);
    EXPECT_FALSE(canMove(*m_colliders[2]));
    m_body.goToSleep();
    EXPECT_TRUE(canMove(*m_colliders[3]));
    m_body.setCanWakeup(false);
    EXPECT_FALSE(canMove(*m_colliders[3]));
}

}  // namespace
}  // namespace bullet_fem
