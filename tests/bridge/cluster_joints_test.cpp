// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/cluster_joints.h"

#include <gtest/gtest.h>

#include "bridge/joint_test_world.h"
#include "bullet_bridge/joints/cluster_motion.h"

namespace bullet_fem
{
namespace
{

class ClusterJointTest : public ::testing::Test
{
protected:
    ClusterJointTest()
    {
        soft().generateClusters(1);
        m_other.m_softBody->generateClusters(1);
        expectOneCluster(soft());
        expectOneCluster(*m_other.m_softBody);
    }

    static void expectOneCluster(const btSoftBody& body) { EXPECT_EQ(body.m_clusters.size(), 1); }

    btSoftBody& soft() { return *m_cube.m_softBody; }

    void appendLinear(btSoftBody::Body other, const btVector3& position)
    {
        btSoftBody::LJoint::Specs specs;
        specs.position = position;
        soft().appendLinearJoint(specs, soft().m_clusters[0], other);
    }

    void appendAngular(btSoftBody::Body other, const btVector3& axis,
                       btSoftBody::AJoint::IControl* control = btSoftBody::AJoint::IControl::Default())
    {
        btSoftBody::AJoint::Specs specs;
        specs.axis = axis;
        specs.icontrol = control;
        soft().appendAngularJoint(specs, soft().m_clusters[0], other);
    }

    ContactProblem& append()
    {
        for (FemSoftBody* fem : m_world.m_bodies) hideClusterJoints(*fem);
        return m_world.append();
    }

    static Vec3 velocityOf(const JointEnd& end, const ContactProblem& problem, const std::vector<Vec3>& v)
    {
        Vec3 sum;
        for (int k = end.m_first; k < end.m_first + end.m_count; ++k)
            sum += problem.m_handleBlocks[k] * v[problem.m_handleNodes[k]];
        return sum;
    }

    static std::vector<Vec3> impulsesOf(const JointEnd& end, const ContactProblem& problem, const Vec3& impulse)
    {
        std::vector<Vec3> result(27);
        for (int k = end.m_first; k < end.m_first + end.m_count; ++k)
            result[problem.m_handleNodes[k]] += transposeTimes(problem.m_handleBlocks[k], impulse);
        return result;
    }

    std::vector<Vec3> rigidVelocities(const Vec3& u, const Vec3& w) const
    {
        std::vector<Vec3> v;
        for (const Vec3& x : m_cube.m_body.m_state.m_x) v.push_back(u + cross(w, x));
        return v;
    }

    JointTestWorld m_world;
    FemSoftBody& m_cube = m_world.addCube();
    FemSoftBody& m_other = m_world.addCube({1, 0, 0});
};

TEST_F(ClusterJointTest, APointOfAClusterMovesAsTheRigidBodyOfItsNodes)
{
    appendLinear(m_other.m_softBody->m_clusters[0], btVector3(1, 0, btScalar(0.5)));
    const ContactProblem& problem = append();
    ASSERT_EQ(problem.m_joints.size(), 1u);
    const Joint& joint = problem.m_joints[0];
    EXPECT_EQ(joint.m_b.m_body, 1);
    const Vec3 u = {1, 2, 3}, w = {-2, 1, 4}, expected = u + cross(w, {1, 0, 0.5});
    expectNear(velocityOf(joint.m_a, problem, rigidVelocities(u, w)), expected, 1e-6);
    expectNear(joint.m_wanted, {}, 1e-4);
}

TEST_F(ClusterJointTest, AnImpulseOnAPointIsHandedToTheNodesWithItsMomenta)
{
    appendLinear(btSoftBody::Body(), btVector3(1, 0, btScalar(0.5)));
    const ContactProblem& problem = append();
    const Vec3 impulse = {3, -1, 2};
    const std::vector<Vec3> p = impulsesOf(problem.m_joints[0].m_a, problem, impulse);
    Vec3 linear, angular;
    for (int i = 0; i < 27; ++i) linear += p[i], angular += cross(m_cube.m_body.m_state.m_x[i], p[i]);
    expectNear(linear, impulse, 1e-12);
    expectNear(angular, cross({1, 0, 0.5}, impulse), 1e-6);
}

TEST_F(ClusterJointTest, TheSpinOfAClusterIsThatOfTheRigidBodyOfItsNodes)
{
    appendAngular(btSoftBody::Body(), btVector3(0, 0, 1));
    const ContactProblem& problem = append();
    ASSERT_EQ(problem.m_joints.size(), 1u);
    const Vec3 w = {-2, 1, 4}, torque = {3, -1, 2};
    expectNear(velocityOf(problem.m_joints[0].m_a, problem, rigidVelocities({1, 2, 3}, w)), w, 1e-6);
    const std::vector<Vec3> p = impulsesOf(problem.m_joints[0].m_a, problem, torque);
    Vec3 linear, angular;
    for (int i = 0; i < 27; ++i) linear += p[i], angular += cross(m_cube.m_body.m_state.m_x[i], p[i]);
    expectNear(linear, {}, 1e-12);
    expectNear(angular, torque, 1e-6);
}

TEST_F(ClusterJointTest, BothBodiesReportOppositeImpulses)
{
    appendLinear(m_other.m_softBody->m_clusters[0], btVector3(1, 0, btScalar(0.5)));
    expectOppositeImpulses(append(), m_cube, m_other, {0, 0, 2});
    EXPECT_EQ(m_other.m_joints.m_now[0].m_object, &soft());
    showClusterJoints(m_cube);
    expectNear(append().m_joints[0].m_impulse, {0, 0, 2}, 1e-12);  // the warm start of the next step
    showClusterJoints(m_cube);
}

TEST_F(ClusterJointTest, PinnedNodesLeadTheirCluster)
{
    soft().releaseClusters();
    soft().setMass(0, 0);
    soft().generateClusters(1);
    appendLinear(btSoftBody::Body(), btVector3(0, 0, 0));
    const ContactProblem& problem = append();
    std::vector<Vec3> v(27);
    v[0] = {1, 0, 0};
    expectNear(velocityOf(problem.m_joints[0].m_a, problem, v), v[0], 1e-5);
}

TEST_F(ClusterJointTest, TheFrameFollowsTheNodesAlsoOfASmallBody)
{
    // Bullet's own frames of clusters of centimetres are turned towards the identity.
    const Mat3 Q = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
    for (Vec3& x : m_cube.m_body.m_state.m_x) x = 0.01 * (Q * x);
    for (int j = 0; j < soft().m_clusters[0]->m_framerefs.size(); ++j)
        soft().m_clusters[0]->m_framerefs[j] *= btScalar(0.01);
    showClusterJoints(m_cube);
    const btMatrix3x3& frame = soft().m_clusters[0]->m_framexform.getBasis();
    EXPECT_NEAR(frame[1][0], 1, 1e-6);
    EXPECT_NEAR(frame[0][0], 0, 1e-6);
    EXPECT_NEAR(soft().m_clusters[0]->m_com.x(), -0.005, 1e-6);
}

TEST_F(ClusterJointTest, BulletsClusterSolverMovesNothing)
{
    btRigidBody& ball = m_world.addRigid(1, btVector3(1, 0, 0));
    appendLinear(&ball, btVector3(1, 0, 0));
    appendAngular(&ball, btVector3(0, 0, 1));
    const btSoftBody::Joint* joint = soft().m_joints[0];
    hideClusterJoints(m_cube);
    ball.setLinearVelocity(btVector3(0, 5, 0));
    soft().m_sst.sdt = btScalar(JointTestWorld::kStep);
    btSoftBody::solveClusters(m_world.world().getSoftBodyArray());
    EXPECT_EQ(ball.getLinearVelocity().y(), 5);
    EXPECT_EQ(ball.getAngularVelocity().length2(), 0);
    showClusterJoints(m_cube);
    ASSERT_EQ(soft().m_joints.size(), 2);
    EXPECT_EQ(soft().m_joints[0], joint);
    EXPECT_EQ(joint->m_bodies[0].m_soft, soft().m_clusters[0]);
    EXPECT_EQ(joint->m_bodies[1].m_rigid, &ball);
}

TEST_F(ClusterJointTest, ContactJointsAreRemoved)
{
    appendLinear(btSoftBody::Body(), btVector3(0, 0, 0));
    auto* contact = new (btAlignedAlloc(sizeof(btSoftBody::CJoint), 16)) btSoftBody::CJoint();
    soft().m_joints.push_back(contact);
    hideClusterJoints(m_cube);
    ASSERT_EQ(soft().m_joints.size(), 1);
    EXPECT_EQ(soft().m_joints[0]->Type(), btSoftBody::Joint::eType::Linear);
    showClusterJoints(m_cube);
}

TEST_F(ClusterJointTest, JointDeletedByACallbackIsForgotten)
{
    appendLinear(btSoftBody::Body(), btVector3(0, 0, 0));
    hideClusterJoints(m_cube);
    btAlignedFree(soft().m_joints[0]);
    soft().m_joints.clear();
    EXPECT_TRUE(m_world.append().m_joints.empty());
    showClusterJoints(m_cube);
}

TEST_F(ClusterJointTest, AJointToADeletedBodyIsRemoved)
{
    btRigidBody& ball = m_world.addRigid(1, btVector3(1, 0, 0));
    appendLinear(&ball, btVector3(1, 0, 0));
    hideClusterJoints(m_cube);
    m_world.deleteRigid(ball);  // as a callback may delete it
    EXPECT_TRUE(m_world.append().m_joints.empty());
    EXPECT_TRUE(m_world.m_flags[0].m_lost);
    EXPECT_EQ(soft().m_joints.size(), 0);
    showClusterJoints(m_cube);
}

TEST_F(ClusterJointTest, JointToASpringBodyIsFlaggedAndIgnored)
{
    appendLinear(m_other.m_softBody->m_clusters[0], btVector3(1, 0, 0));
    m_world.m_bodies.pop_back();  // now a plain soft body of the world
    EXPECT_TRUE(append().m_joints.empty());
    EXPECT_TRUE(m_world.m_flags[0].m_bad);
    EXPECT_EQ(soft().m_joints.size(), 1);
    showClusterJoints(m_cube);
}

TEST_F(ClusterJointTest, TakesBackTheShareErpOfADistance)
{
    btRigidBody& ball = m_world.addRigid(0, btVector3(1, 0, 0));
    appendLinear(&ball, btVector3(1, 0, 0));
    soft().m_joints[0]->m_erp = btScalar(0.5);
    soft().m_joints[0]->m_cfm = btScalar(0.25);
    soft().m_joints[0]->m_refs[1] += btVector3(0, 0, btScalar(0.01));
    const Joint joint = append().m_joints[0];
    expectNear(joint.m_wanted, {0, 0, 0.005 / JointTestWorld::kStep}, 1e-4);
    EXPECT_NEAR(joint.m_softness, 3, 1e-6);
}

TEST_F(ClusterJointTest, AnAxisIsTurnedBackAndItsSpinLeftFree)
{
    btRigidBody& ball = m_world.addRigid(0, btVector3(1, 0, 0));
    appendAngular(&ball, btVector3(0, 0, 1));
    ball.setWorldTransform(btTransform(btQuaternion(btVector3(1, 0, 0), btScalar(0.1)), btVector3(1, 0, 0)));
    const Joint joint = append().m_joints[0];
    expectNear(joint.m_axes[0], {0, 0, 1}, 1e-6);
    EXPECT_EQ(joint.m_limit.x, 0);
    EXPECT_EQ(joint.m_limit.y, Joint::kUnlimited);
    Vec3 wanted;
    for (int i = 1; i < 3; ++i) wanted += joint.m_wanted[i] * joint.m_axes[i];
    expectNear(wanted, {0.1 / JointTestWorld::kStep, 0, 0}, 1e-3);  // the cluster turns towards the ball's axis
    EXPECT_TRUE(joint.m_b.m_angular);
}

TEST_F(ClusterJointTest, MotorHoldsItsSpeed)
{
    struct Motor : btSoftBody::AJoint::IControl
    {
        btScalar Speed(btSoftBody::AJoint* joint, btScalar current) override
        {
            m_current = current;
            m_sawRigid = joint->m_bodies[1].m_rigid != nullptr;
            ++m_calls;
            return 7;
        }
        btScalar m_current = 0;
        bool m_sawRigid = false;
        int m_calls = 0;
    } motor;
    btRigidBody& ball = m_world.addRigid(1, btVector3(1, 0, 0));
    ball.setAngularVelocity(btVector3(0, 0, 2));
    appendAngular(&ball, btVector3(0, 0, 1), &motor);
    const Joint joint = append().m_joints[0];
    EXPECT_NEAR(joint.m_wanted.x, 7, 1e-6);
    EXPECT_EQ(joint.m_limit.x, Joint::kUnlimited);
    EXPECT_NEAR(motor.m_current, -2, 1e-5);  // the cluster's spin minus the ball's
    EXPECT_TRUE(motor.m_sawRigid);
    soft().m_sst.sdt = btScalar(JointTestWorld::kStep);
    btSoftBody::solveClusters(m_world.world().getSoftBodyArray());
    EXPECT_EQ(motor.m_calls, 1);
    showClusterJoints(m_cube);
}

TEST_F(ClusterJointTest, BadValuesAreFlaggedAndIgnored)
{
    appendLinear(btSoftBody::Body(), btVector3(NAN, 0, 0));
    appendLinear(btSoftBody::Body(), btVector3(0, 0, 0));
    soft().m_joints[1]->m_cfm = 0;
    appendAngular(btSoftBody::Body(), btVector3(0, 0, 0));
    EXPECT_TRUE(append().m_joints.empty());
    EXPECT_TRUE(m_world.m_flags[0].m_bad);
    showClusterJoints(m_cube);
}

}  // namespace
}  // namespace bullet_fem
