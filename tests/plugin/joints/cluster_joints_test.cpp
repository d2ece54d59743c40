// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Linear and angular joints of FEM bodies' clusters, in staggered coupling.
#include <gtest/gtest.h>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

class Motor : public btSoftBody::AJoint::IControl
{
public:
    explicit Motor(btScalar speed) : m_speed(speed) {}
    btScalar Speed(btSoftBody::AJoint*, btScalar) override { return m_speed; }

private:
    btScalar m_speed;  // [rad/s]
};

class JointScenesTest : public EachWorld
{
protected:
    explicit JointScenesTest(const btVector3& gravity = {0, 0, btScalar(-kGravity)}) : m_world(GetParam(), gravity) {}

    /// A stiff bar with clusters from x = from to x = from + 1, 0.2 m thick.
    btSoftBody& addBar(btScalar from, int clusters)
    {
        btSoftBody& bar = m_world.addSoft(
            btFemHelpers::createBox(m_world.info(), btVector3(from + btScalar(0.5), 0, 0),
                                    btVector3(btScalar(0.5), btScalar(0.1), btScalar(0.1)), btScalar(0.1)));
        btFemMaterial material;
        material.m_youngModulus = btScalar(1e7);
        m_fem.setMaterial(&bar, material);
        bar.generateClusters(clusters);
        return bar;
    }

    btRigidBody& addBall(btScalar mass, const btVector3& position)
    {
        return m_world.addRigid(new btSphereShape(btScalar(0.1)), {mass, at(position.x(), position.y(), position.z())});
    }

    static btSoftBody::Cluster* nearestCluster(btSoftBody& body, const btVector3& point)
    {
        btSoftBody::Cluster* nearest = body.m_clusters[0];
        for (int c = 1; c < body.m_clusters.size(); ++c)
            if (body.m_clusters[c]->m_com.distance(point) < nearest->m_com.distance(point))
                nearest = body.m_clusters[c];
        return nearest;
    }

    static void hinge(btSoftBody& body, btSoftBody::Body other, const btVector3& position)
    {
        btSoftBody::LJoint::Specs specs;
        specs.position = position;
        body.appendLinearJoint(specs, nearestCluster(body, position), other);
    }

    static void turnAbout(btSoftBody& body, btSoftBody::Body other, const btVector3& axis,
                          btSoftBody::AJoint::IControl* control)
    {
        btSoftBody::AJoint::Specs specs;
        specs.axis = axis;
        specs.icontrol = control;
        body.appendAngularJoint(specs, body.m_clusters[0], other);
    }

    /// Angular velocity of the rigid body with equal momenta.
    static Vec3 spinOf(const btSoftBody& body)
    {
        const Vec3 center = centerOf(body), drift = velocityOf(body);
        Vec3 momentum;
        Mat3 inertia;
        for (int i = 0; i < body.m_nodes.size(); ++i)
        {
            const double m = 1 / double(body.m_nodes[i].m_im);
            const Vec3 d = vec3(body.m_nodes[i].m_x) - center;
            momentum += m * cross(d, vec3(body.m_nodes[i].m_v) - drift);
            inertia += m * (Mat3::diagonal(dot(d, d)) - outer(d, d));
        }
        return inverse(inertia) * momentum;
    }

    Vec3 impulse(const btSoftBody& body, int joint) const
    {
        EXPECT_GT(m_fem.anchors(&body).size(), joint);
        return vec3(m_fem.anchors(&body)[joint].m_impulse);
    }

    FemWorld m_world;
    btFemSoftBodySolver& m_fem = m_world.fem();
};

class FloatingJointScenesTest : public JointScenesTest
{
protected:
    FloatingJointScenesTest() : JointScenesTest(btVector3(0, 0, 0)) {}
};

INSTANTIATE_TEST_SUITE_P(Worlds, JointScenesTest, eachWorld(), nameOfWorld);

INSTANTIATE_TEST_SUITE_P(Worlds, FloatingJointScenesTest, eachWorld(), nameOfWorld);

TEST_P(JointScenesTest, ABarHangsHingedOnAnother)
{
    btSoftBody &fixed = addBar(0, 5), &hanging = addBar(1, 5);
    for (int i = 0; i < fixed.m_nodes.size(); ++i)
        if (fixed.m_nodes[i].m_x.x() < btScalar(0.01)) fixed.setMass(i, 0);
    const btVector3 position(1, 0, 0);
    hinge(hanging, nearestCluster(fixed, position), position);
    hanging.m_collisionDisabledObjects.push_back(&fixed);
    hanging.m_cfg.kDP = hanging.m_cfg.drag = btScalar(0.02);  // a deformable world uses the latter
    double farthest = 0;
    for (int k = 0; k < 900; ++k)
    {
        m_world.step();
        farthest = std::max(farthest, double(m_fem.anchors(&hanging)[0].m_error));
    }
    EXPECT_LT(farthest, 5e-3);
    const Vec3 center = centerOf(hanging);
    EXPECT_LT(center.z, -0.45);  // it has swung downwards
    const Vec3 force = (1 / double(kStep)) * impulse(hanging, 0);
    EXPECT_LT(norm(force - Vec3{0, 0, 40 * kGravity}), 1e-3 * 40 * kGravity);
    EXPECT_LT(m_fem.anchors(&hanging)[0].m_error, 1e-5);
    EXPECT_EQ(m_fem.anchors(&hanging)[0].m_object, &fixed);
}

TEST_P(FloatingJointScenesTest, AJointToARigidBodyConservesMomentum)
{
    btSoftBody& bar = addBar(0, 5);
    btRigidBody& ball = addBall(10, {btScalar(1.2), 0, 0});
    hinge(bar, &ball, btVector3(1, 0, 0));
    ball.setLinearVelocity(btVector3(0, 2, 0));
    Motion before = motionOf(bar), after;
    before += motionOf(ball);
    m_world.step(300);
    after = motionOf(bar);
    after += motionOf(ball);
    EXPECT_LT(norm(after.m_linear - before.m_linear), 1e-6 * norm(before.m_linear));
    EXPECT_LT(norm(after.m_angular - before.m_angular), 1e-5 * norm(before.m_angular));
    EXPECT_GT(norm(motionOf(bar).m_linear), 0.05 * norm(before.m_linear));
    EXPECT_LT(m_fem.anchors(&bar)[0].m_error, 2e-3);
}

TEST_P(FloatingJointScenesTest, AMotorTurnsASoftBodyOnAStaticAxle)
{
    btSoftBody& bar = addBar(btScalar(-0.5), 1);
    btRigidBody& axle = addBall(0, {0, 0, 1});
    hinge(bar, &axle, btVector3(0, 0, 0));
    Motor motor(3);
    turnAbout(bar, &axle, btVector3(0, 0, 1), &motor);
    m_world.step(120);
    EXPECT_LT(norm(spinOf(bar) - Vec3{0, 0, 3}), 1e-2);
    EXPECT_LT(norm(centerOf(bar)), 1e-4);
}

TEST_P(FloatingJointScenesTest, AMotorTurnsARigidBodyTheOtherWay)
{
    btSoftBody& bar = addBar(btScalar(-0.5), 1);
    btRigidBody& ball = addBall(50, {0, 0, btScalar(0.3)});
    hinge(bar, &ball, btVector3(0, 0, btScalar(0.2)));
    Motor motor(3);
    turnAbout(bar, &ball, btVector3(0, 0, 1), &motor);
    m_world.step(60);
    EXPECT_NEAR(spinOf(bar).z - ball.getAngularVelocity().z(), 3, 0.03);
    Motion sum = motionOf(bar);
    sum += motionOf(ball);
    EXPECT_LT(norm(sum.m_linear), 1e-4);
    EXPECT_LT(norm(sum.m_angular), 1e-3 * norm(motionOf(bar).m_angular));
}

TEST_P(FloatingJointScenesTest, AnAngularJointLeavesTheSpinAboutItsAxisFree)
{
    btSoftBody& bar = addBar(btScalar(-0.5), 1);
    btRigidBody& axle = addBall(0, {0, 0, 1});
    turnAbout(bar, &axle, btVector3(0, 0, 1), btSoftBody::AJoint::IControl::Default());
    for (int i = 0; i < bar.m_nodes.size(); ++i)
        bar.m_nodes[i].m_v =
            btVector3(0, 1, btScalar(0.5)).cross(bar.m_nodes[i].m_x) + btVector3(0, 0, 2).cross(bar.m_nodes[i].m_x);
    m_world.step(120);
    const Vec3 spin = spinOf(bar);
    EXPECT_NEAR(spin.z, 2.5, 0.05);
    EXPECT_LT(std::hypot(spin.x, spin.y), 0.01);
    EXPECT_LT(m_fem.anchors(&bar)[0].m_error, 1e-3);
}

TEST_P(FloatingJointScenesTest, TheImpulsesAreGivenOnce)
{
    // Bullet's own cluster solver would move the ball without a reaction on the nodes.
    btSoftBody& bar = addBar(0, 5);
    btRigidBody& ball = addBall(10, {btScalar(1.2), 0, 0});
    hinge(bar, &ball, btVector3(1, 0, 0));
    m_world.step();
    bar.forceActivationState(DISABLE_SIMULATION);
    ball.setLinearVelocity(btVector3(0, 2, 0));
    m_world.step(10);
    EXPECT_EQ(ball.getLinearVelocity().y(), 2);
}

TEST_P(JointScenesTest, AJointToADeletedBodyIsRemoved)
{
    btSoftBody& bar = addBar(0, 5);
    btRigidBody& ball = addBall(0, {btScalar(1.2), 0, 0});
    hinge(bar, &ball, btVector3(1, 0, 0));
    m_world.step(10);
    EXPECT_EQ(bar.m_joints.size(), 1);
    m_world.deleteRigid(ball);
    m_world.step();
    EXPECT_NE(m_fem.stepReport(&bar).m_flags & BT_FEM_LOST_ANCHOR, 0);
    EXPECT_EQ(bar.m_joints.size(), 0);
    m_world.step();
    EXPECT_EQ(m_fem.anchors(&bar).size(), 0);
}

TEST_P(JointScenesTest, AJointToADeletedSoftBodyIsRemoved)
{
    btSoftBody &bar = addBar(0, 5), &other = addBar(1, 5);
    hinge(bar, nearestCluster(other, btVector3(1, 0, 0)), btVector3(1, 0, 0));
    m_world.step(10);
    m_world.deleteSoft(other);
    m_world.step();
    EXPECT_NE(m_fem.stepReport(&bar).m_flags & BT_FEM_LOST_ANCHOR, 0);
    EXPECT_EQ(bar.m_joints.size(), 0);
}

TEST_P(JointScenesTest, ACallbackMayDeleteABodyWithJoints)
{
    btSoftBody &bar = addBar(0, 5), &other = addBar(1, 5);
    hinge(bar, nearestCluster(other, btVector3(1, 0, 0)), btVector3(1, 0, 0));
    m_world.step(2);
    struct Scene
    {
        SoftWorld& m_world;
        btSoftBody* m_doomed;
    } scene = {m_world, &bar};
    m_world.bullet().setInternalTickCallback(
        [](btDynamicsWorld* world, btScalar)
        {
            auto& all = *static_cast<Scene*>(world->getWorldUserInfo());
            if (all.m_doomed) all.m_world.deleteSoft(*all.m_doomed);
            all.m_doomed = nullptr;
        },
        &scene);
    m_world.step(3);
    EXPECT_TRUE(allFinite(other));
    EXPECT_FALSE(m_fem.isFem(&bar));
}

}  // namespace
}  // namespace bullet_fem
