// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/soft_joints.h"

#include <gtest/gtest.h>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "LinearMath/btTransformUtil.h"
#include "bridge/joint_test_world.h"
#include "bullet_bridge/joints/node_attachments.h"

namespace bullet_fem
{
namespace
{

class SoftAnchorTest : public ::testing::Test
{
protected:
    btSoftBody& soft() { return *m_cube.m_softBody; }
    Vec3 position(int node) const { return m_cube.m_body.m_state.m_x[node]; }

    /// The node's position at the end of the step if the joint reaches its target velocity and the object keeps its
    /// velocity.
    Vec3 endOfNode(const Joint& joint, int node, const btRigidBody& body) const
    {
        const Vec3 arm = joint.m_b.m_point - m_world.m_rigidProxies.rigidProxies()[joint.m_b.m_rigidProxy].m_center;
        const Vec3 v = vec3(body.getLinearVelocity()) + cross(vec3(body.getAngularVelocity()), arm);
        return position(node) + JointTestWorld::kStep * (v + joint.m_wanted);
    }

    JointTestWorld m_world;
    FemSoftBody& m_cube = m_world.addCube();
};

TEST_F(SoftAnchorTest, JoinsItsNodeToTheRigidBody)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendAnchor(5, &wall);
    const ContactProblem& problem = m_world.append();
    ASSERT_EQ(problem.m_joints.size(), 1u);
    const Joint& joint = problem.m_joints[0];
    EXPECT_EQ(joint.m_a.m_body, 0);
    ASSERT_EQ(joint.m_a.m_count, 1);
    EXPECT_EQ(problem.m_handleNodes[joint.m_a.m_first], 5);
    EXPECT_EQ(squaredNorm(problem.m_handleBlocks[joint.m_a.m_first] - Mat3::identity()), 0);
    EXPECT_EQ(&m_world.m_rigidProxies.object(joint.m_b.m_rigidProxy), &wall);
    expectNear(joint.m_b.m_point, position(5), 1e-12);
    expectNear(joint.m_wanted, {}, 1e-5);  // single precision rounding of the pivot, over the step
    EXPECT_EQ(joint.m_softness, 0);
}

TEST_F(SoftAnchorTest, TakesBackTheShareKAHROfADistance)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().m_cfg.kAHR = btScalar(0.5);
    soft().appendAnchor(5, &wall, bulletVector(position(5) + Vec3{0.01, 0, 0}));
    expectNear(m_world.append().m_joints[0].m_wanted, {0.005 / JointTestWorld::kStep, 0, 0}, 1e-4);
}

TEST_F(SoftAnchorTest, AFarPivotPullsItsNodeInByAQuarterOfAnEdgeAStep)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendAnchor(5, &wall, bulletVector(position(5) + Vec3{0, 7, 0}));
    const double edge = m_cube.m_body.m_model->mesh().meanEdgeLength();
    expectNear(m_world.append().m_joints[0].m_wanted, {0, 0.25 * edge / JointTestWorld::kStep, 0}, 1e-4);
}

TEST_F(SoftAnchorTest, NodeEndsTheStepOnThePivotOfAMovedBody)
{
    btRigidBody& body = m_world.addRigid(2, btVector3(3, 0, 0));
    soft().appendAnchor(5, &body);
    const btVector3 local = soft().m_anchors[0].m_local;
    body.setLinearVelocity(btVector3(1, 2, 3));
    body.setAngularVelocity(btVector3(0, 4, -5));
    btTransform moved;
    btTransformUtil::integrateTransform(body.getWorldTransform(), body.getLinearVelocity(), body.getAngularVelocity(),
                                        btScalar(JointTestWorld::kStep), moved);
    body.setCenterOfMassTransform(moved);
    const Joint joint = m_world.append(RigidPhase::moved).m_joints[0];
    expectNear(endOfNode(joint, 5, body), vec3(moved * local), 1e-6);
}

TEST_F(SoftAnchorTest, NodeEndsTheStepOnThePivotOfAMovingBody)
{
    btRigidBody& body = m_world.addRigid(2, btVector3(3, 0, 0));
    soft().appendAnchor(5, &body);
    body.setLinearVelocity(btVector3(1, 2, 3));
    body.setAngularVelocity(btVector3(0, 4, -5));
    btTransform moved;
    btTransformUtil::integrateTransform(body.getWorldTransform(), body.getLinearVelocity(), body.getAngularVelocity(),
                                        btScalar(JointTestWorld::kStep), moved);
    const Joint joint = m_world.append(RigidPhase::solving).m_joints[0];
    expectNear(endOfNode(joint, 5, body), vec3(moved * soft().m_anchors[0].m_local), 1e-6);
}

TEST_F(SoftAnchorTest, NodeEndsTheStepOnThePivotOfAKinematicBody)
{
    btRigidBody& body = m_world.addRigid(0, btVector3(3, 0, 0));
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    body.setActivationState(DISABLE_DEACTIVATION);
    soft().appendAnchor(5, &body);
    btTransform moved = body.getWorldTransform();
    moved.setOrigin(btVector3(3, 0, btScalar(0.1)));
    moved.setRotation(btQuaternion(btVector3(1, 0, 0), btScalar(0.2)));
    body.setWorldTransform(moved);
    body.saveKinematicState(btScalar(JointTestWorld::kStep));
    const Joint joint = m_world.append(RigidPhase::solving).m_joints[0];
    expectNear(endOfNode(joint, 5, body), vec3(moved * soft().m_anchors[0].m_local), 1e-5);
}

TEST_F(SoftAnchorTest, SleepingKinematicBodyStandsStill)
{
    btRigidBody& body = m_world.addRigid(0);
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    soft().appendAnchor(5, &body);
    body.setInterpolationLinearVelocity(btVector3(1, 0, 0));
    body.setActivationState(ISLAND_SLEEPING);
    expectNear(m_world.append().m_joints[0].m_wanted, {}, 1e-5);
    expectNear(m_world.m_rigidProxies.rigidProxies()[0].m_linearVelocity, {}, 1e-12);
}

TEST_F(SoftAnchorTest, InfluenceSoftensTheAnchor)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendAnchor(5, &wall, false, btScalar(0.25));
    soft().appendAnchor(6, &wall, false, 0);
    const ContactProblem& problem = m_world.append();
    ASSERT_EQ(problem.m_joints.size(), 1u);
    EXPECT_NEAR(problem.m_joints[0].m_softness, 3, 1e-6);
}

TEST_F(SoftAnchorTest, PinnedNodeIsHeldToMovableObjectsOnly)
{
    btRigidBody &wall = m_world.addRigid(0), &ball = m_world.addRigid(1);
    soft().appendAnchor(5, &wall);
    soft().appendAnchor(5, &ball);
    m_cube.m_body.m_state.m_fixed[5] = 1;
    const ContactProblem& problem = m_world.append();
    ASSERT_EQ(problem.m_joints.size(), 1u);
    EXPECT_EQ(&m_world.m_rigidProxies.object(problem.m_joints[0].m_b.m_rigidProxy), &ball);
}

TEST_F(SoftAnchorTest, ADeformableAnchorIsOneToo)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendDeformableAnchor(7, &wall);
    const ContactProblem& problem = m_world.append();
    ASSERT_EQ(problem.m_joints.size(), 1u);
    EXPECT_EQ(problem.m_handleNodes[problem.m_joints[0].m_a.m_first], 7);
    expectNear(problem.m_joints[0].m_wanted, {}, 1e-5);
}

TEST_F(SoftAnchorTest, AnchorsToADeletedBodyAreRemovedAndTheNodeCollidesAgain)
{
    btRigidBody &wall = m_world.addRigid(0), &other = m_world.addRigid(0);
    soft().appendAnchor(5, &wall);
    soft().appendDeformableAnchor(6, &wall);
    soft().appendAnchor(7, &other);
    m_world.append();
    EXPECT_NE(soft().m_nodes[5].m_battach, 0);
    m_world.deleteRigid(wall);
    const ContactProblem& problem = m_world.append();
    EXPECT_TRUE(m_world.m_flags[0].m_lost);
    EXPECT_EQ(problem.m_joints.size(), 1u);
    ASSERT_EQ(soft().m_anchors.size(), 1);
    EXPECT_EQ(soft().m_anchors[0].m_node, &soft().m_nodes[7]);
    EXPECT_EQ(soft().m_deformableAnchors.size(), 0);
    EXPECT_EQ(soft().m_nodes[5].m_battach, 0);
    EXPECT_EQ(soft().m_nodes[6].m_battach, 0);
    EXPECT_NE(soft().m_nodes[7].m_battach, 0);
    m_world.append();
    EXPECT_FALSE(m_world.m_flags[0].m_lost);
}

TEST_F(SoftAnchorTest, BodyAtAReusedAddressIsNotHeld)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendAnchor(5, &wall);
    m_world.append();
    m_world.world().removeRigidBody(&wall);  // a new broadphase id at the old address, elsewhere
    wall.setWorldTransform(btTransform(btMatrix3x3::getIdentity(), btVector3(0, 50, 0)));
    m_world.world().addRigidBody(&wall);
    m_world.append();
    EXPECT_TRUE(m_world.m_flags[0].m_lost);
    EXPECT_EQ(soft().m_anchors.size(), 0);
}

TEST_F(SoftAnchorTest, ReinsertedBodyIsStillHeld)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendAnchor(5, &wall);
    m_world.append();
    m_world.world().removeRigidBody(&wall);  // Bullet's procedure to change a mass
    m_world.world().addRigidBody(&wall);
    EXPECT_EQ(m_world.append().m_joints.size(), 1u);
    EXPECT_FALSE(m_world.m_flags[0].m_lost);
}

TEST_F(SoftAnchorTest, RemoveAnchorLetsTheNodeCollideAgain)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendDeformableAnchor(7, &wall);
    m_world.append();
    soft().removeAnchor(7);
    EXPECT_TRUE(m_world.append().m_joints.empty());
    EXPECT_EQ(soft().m_nodes[7].m_battach, 0);
    EXPECT_FALSE(m_world.m_flags[0].m_lost);
}

TEST_F(SoftAnchorTest, AForeignNodeIsFlaggedAndIgnored)
{
    btRigidBody& wall = m_world.addRigid(0);
    FemSoftBody& other = m_world.addCube({5, 0, 0});
    soft().appendAnchor(5, &wall);
    soft().m_anchors[0].m_node = &other.m_softBody->m_nodes[5];
    EXPECT_TRUE(m_world.append().m_joints.empty());
    EXPECT_TRUE(m_world.m_flags[0].m_bad);
    EXPECT_EQ(soft().m_anchors.size(), 1);
}

TEST_F(SoftAnchorTest, NonFiniteValuesAreFlaggedAndIgnored)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendAnchor(5, &wall, btVector3(NAN, 0, 0));
    soft().appendAnchor(6, &wall, false, btScalar(NAN));
    EXPECT_TRUE(m_world.append().m_joints.empty());
    EXPECT_TRUE(m_world.m_flags[0].m_bad);
}

TEST_F(SoftAnchorTest, ImpulseWarmStartsTheNextStepAtAnyAnchorIndex)
{
    btRigidBody& wall = m_world.addRigid(0);
    soft().appendAnchor(5, &wall);
    soft().appendAnchor(6, &wall);
    ContactProblem& problem = m_world.append();
    problem.m_joints[1].m_impulse = {1, 2, 3};
    SoftJoints::takeBack(m_cube, problem);
    soft().m_anchors.removeAtIndex(0);
    const ContactProblem& next = m_world.append();
    ASSERT_EQ(next.m_joints.size(), 1u);
    expectNear(next.m_joints[0].m_impulse, {1, 2, 3}, 1e-12);
}

TEST_F(SoftAnchorTest, KnowsItsNodeAndItsObject)
{
    btRigidBody &wall = m_world.addRigid(0), &other = m_world.addRigid(0);
    soft().appendAnchor(5, &wall);
    soft().appendDeformableAnchor(6, &other);
    m_world.append();
    EXPECT_TRUE(isAnchoredTo(m_cube, 5, wall));
    EXPECT_FALSE(isAnchoredTo(m_cube, 5, other));
    EXPECT_TRUE(isAnchoredTo(m_cube, 6, other));
    EXPECT_FALSE(isAnchoredTo(m_cube, 7, wall));
}

TEST_F(SoftAnchorTest, AMultibodysLinkLeadsItsNode)
{
    btMultiBody robot(1, 1, btVector3(1, 1, 1), false, false);
    robot.setupRevolute(0, 1, btVector3(1, 1, 1), -1, btQuaternion::getIdentity(), btVector3(0, 0, 1),
                        btVector3(0, 0, 0), btVector3(2, 0, 0));
    robot.finalizeMultiDof();
    robot.setBaseVel(btVector3(0, 3, 0));
    robot.setJointVel(0, 4);
    btBoxShape shape(btVector3(1, 1, 1));
    btMultiBodyLinkCollider link(&robot, 0);
    link.setCollisionShape(&shape);
    robot.getLink(0).m_collider = &link;
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> places;
    robot.updateCollisionObjectWorldTransforms(turns, places);
    m_world.world().addCollisionObject(&link);

    soft().appendDeformableAnchor(5, &link);
    ASSERT_EQ(m_world.append().m_joints.size(), 1u);
    const LinkMotion motion = m_world.m_rigidProxies.motionNow(0);
    expectNear(motion.m_angular, {0, 0, 4}, 1e-6);
    expectNear(motion.m_linear, {0, 3 + 4 * 2, 0}, 1e-5);
    EXPECT_TRUE(m_world.m_rigidProxies.rigidProxies()[0].canMove());
    m_world.world().removeCollisionObject(&link);
}

TEST_F(SoftAnchorTest, LinkedBodiesMayIgnoreEachOther)
{
    btRigidBody &wall = m_world.addRigid(0), &other = m_world.addRigid(0), &third = m_world.addRigid(0);
    soft().appendAnchor(5, &wall, true);
    soft().appendAnchor(5, &other, false);
    third.setIgnoreCollisionCheck(&soft(), true);
    EXPECT_TRUE(ignoresCollision(soft(), wall));
    EXPECT_FALSE(ignoresCollision(soft(), other));
    EXPECT_TRUE(ignoresCollision(soft(), third));
}

class NodeAttachmentTest : public SoftAnchorTest
{
protected:
    void attach(int node, const std::array<int, 4>& nodes, const std::array<double, 4>& weights)
    {
        NodeAttachment attachment;
        attachment.m_id = ++m_cube.m_joints.m_lastId;
        attachment.m_node = node;
        attachment.m_other = m_other.m_softBody;
        attachment.m_otherMark = m_other.m_setUp.m_mark;
        attachment.m_otherNodes = nodes;
        attachment.m_weights = weights;
        m_cube.m_joints.m_attachments.push_back(attachment);
    }

    FemSoftBody& m_other = m_world.addCube({1.01, 0, 0});
};

TEST_F(NodeAttachmentTest, JoinsANodeToAPointOfAnotherBody)
{
    attach(3, {0, 1, 2, 2}, {0.25, 0.75, 0, 0});
    const ContactProblem& problem = m_world.append();
    ASSERT_EQ(problem.m_joints.size(), 1u);
    const Joint& joint = problem.m_joints[0];
    EXPECT_EQ(joint.m_b.m_body, 1);
    ASSERT_EQ(joint.m_b.m_count, 2);
    EXPECT_EQ(problem.m_handleNodes[joint.m_b.m_first + 1], 1);
    EXPECT_EQ(problem.m_handleBlocks[joint.m_b.m_first + 1](2, 2), 0.75);
    const std::vector<Vec3>& x = m_other.m_body.m_state.m_x;
    const Vec3 gap = 0.25 * x[0] + 0.75 * x[1] - position(3);
    EXPECT_LT(norm(cross(joint.m_wanted, gap)), 1e-12);  // the direction to the point
    EXPECT_GT(dot(joint.m_wanted, gap), 0);
}

TEST_F(NodeAttachmentTest, BothBodiesReportOppositeImpulses)
{
    attach(3, {0, 0, 0, 0}, {1, 0, 0, 0});
    expectOppositeImpulses(m_world.append(), m_cube, m_other, {0, 0, 2});
    expectNear(m_world.append().m_joints[0].m_impulse, {0, 0, 2}, 1e-12);
}

TEST_F(NodeAttachmentTest, ABodyOutsideTheSolveStandsStill)
{
    attach(3, {0, 0, 0, 0}, {1, 0, 0, 0});
    m_world.m_bodies.pop_back();
    m_world.m_outside.push_back(&m_other);
    const Joint joint = m_world.append().m_joints[0];
    EXPECT_EQ(joint.m_b.m_body, -1);
    EXPECT_EQ(joint.m_b.m_rigidProxy, -1);
    EXPECT_TRUE(m_world.m_flags[0].m_outside);  // awake: the two should have been solved together
}

TEST_F(NodeAttachmentTest, KnowsBothItsSides)
{
    attach(3, {0, 1, 2, 2}, {0.25, 0.75, 0, 0});
    EXPECT_TRUE(isPointAttached(m_cube, pointOf(0, {9, 3, 8}, {1, 0, 0}), m_other));
    EXPECT_FALSE(isPointAttached(m_cube, pointOf(0, {9, 4, 8}, {1, 0, 0}), m_other));
    EXPECT_TRUE(isPointAttached(m_other, pointOf(0, {9, 1, 8}, {1, 0, 0}), m_cube));
    EXPECT_FALSE(isPointAttached(m_other, pointOf(0, {9, 2, 8}, {1, 0, 0}), m_cube));  // has no weight
}

TEST_F(NodeAttachmentTest, AnAwakeBodyOutsideTheSolveIsKnownToReachIn)
{
    attach(3, {0, 0, 0, 0}, {1, 0, 0, 0});
    EXPECT_TRUE(reachesInto(m_cube, {&m_other}));
    EXPECT_FALSE(reachesInto(m_other, {&m_cube}));
}

TEST_F(NodeAttachmentTest, EndsWithTheOtherBody)
{
    attach(3, {0, 0, 0, 0}, {1, 0, 0, 0});
    m_world.m_bodies.pop_back();
    EXPECT_TRUE(m_world.append().m_joints.empty());
    EXPECT_TRUE(m_world.m_flags[0].m_lost);
    EXPECT_TRUE(m_cube.m_joints.m_attachments.empty());
}

}  // namespace
}  // namespace bullet_fem
