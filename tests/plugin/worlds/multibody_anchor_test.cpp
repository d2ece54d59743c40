// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "plugin/scenes/multibody_scene.h"

namespace bullet_fem
{
namespace
{

class HeldMultiBody : public MultiBodyWorldTest
{
protected:
    static constexpr btScalar kMass = 10;
    static constexpr double kHalf = 0.1;

    // A chain of `links` boxes below a base, all with hinges along y; its top is at `height`.
    btMultiBody& addHangingChain(MultiBodyWorld& world, int links, double height)
    {
        const btScalar edge = btScalar(kHalf);
        const btVector3 half(edge, edge, edge), arm(0, 0, -edge);
        const btVector3 inertia = boxInertia(kMass, half);
        auto* body = new btMultiBody(links, kMass, inertia, false, false);
        for (int k = 0; k < links; ++k)
            body->setupRevolute(k, kMass, inertia, k - 1, kNoTurn, btVector3(0, 1, 0), arm, arm, true);
        body->setBasePos(btVector3(0, 0, btScalar(height - kHalf)));
        world.addMultiBody(body);
        for (int k = -1; k < links; ++k) world.addCollider(*body, k, new btBoxShape(half));
        return *body;
    }

    Vec3 anchorForce(const btSoftBody& cube) const
    {
        Vec3 sum;
        for (int k = 0; k < m_fem.anchors(&cube).size(); ++k) sum += vec3(m_fem.anchors(&cube)[k].m_impulse);
        return (1 / double(kStep)) * sum;
    }
};

TEST_F(HeldMultiBody, AnAnchoredSoftBodyCarriesTheWholeChain)
{
    MultiBodyWorld world(m_fem);
    btSoftBody& cube = addCube(world, {0, 0, 0.2});
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() > btScalar(0.39)) cube.setMass(i, 0);
    btMultiBody& chain = addHangingChain(world, 2, -0.001);
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() < btScalar(0.01) && std::fabs(cube.m_nodes[i].m_x.x()) < btScalar(0.15))
            cube.appendDeformableAnchor(i, chain.getBaseCollider());
    ASSERT_GT(cube.m_deformableAnchors.size(), 3);
    world.step(600);
    const double weight = 3 * kMass * kGravity;
    Vec3 force;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        force += (1.0 / 60) * anchorForce(cube);
    }
    EXPECT_NEAR(force.z, -weight, 2e-3 * weight);
    for (int k = 0; k < m_fem.anchors(&cube).size(); ++k) EXPECT_LT(m_fem.anchors(&cube)[k].m_error, 1e-3);
}

TEST_F(HeldMultiBody, SoftBodyOnAMovingLinkPullsAtItsJoint)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBodyLinkCollider& link =
        addSlider(world, 20, btVector3(1, 0, 0), btVector3(btScalar(0.3), btScalar(0.3), btScalar(0.1)), {0, 0, 0});
    btSoftBody& cube = addCube(world, {0, 0, -0.32});
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() > btScalar(-0.13)) cube.appendDeformableAnchor(i, &link);
    link.m_multiBody->setJointVel(0, 2);
    double worst = 0;
    for (int k = 0; k < 120; ++k)
    {
        world.step();
        const double momentum = motionOf(cube).m_linear.x + 20 * double(link.m_multiBody->getJointVel(0));
        worst = std::max(worst, std::fabs(momentum - 40) / 40);
    }
    EXPECT_LT(worst, 2e-5);
    EXPECT_GT(velocityOf(cube).x, 0.3);
}

TEST_F(HeldMultiBody, SleepingMultibodyIsWokenByAFallingBody)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBody& chain = addHangingChain(world, 1, 0.1);
    chain.setCanSleep(true);
    for (int k = -1; k < 1; ++k)
        (k < 0 ? chain.getBaseCollider() : chain.getLinkCollider(k))->forceActivationState(ACTIVE_TAG);
    world.step(240);
    ASSERT_FALSE(chain.isAwake());
    btSoftBody& cube = addCube(world, {0, 0, 0.4});
    cube.setVelocity(btVector3(0, 0, -2));
    world.step(30);
    EXPECT_TRUE(chain.isAwake());
    EXPECT_LT(chain.getBaseVel().z(), -0.5);
}

// They are apart, in separate islands: only the anchor's impulse can wake it.
TEST_F(HeldMultiBody, ASleepingMultibodyIsWokenByAnAnchorFarAway)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBody& chain = addHangingChain(world, 0, 0.1);
    chain.setCanSleep(true);
    chain.getBaseCollider()->forceActivationState(ACTIVE_TAG);
    world.step(300);
    ASSERT_EQ(chain.getBaseCollider()->getActivationState(), ISLAND_SLEEPING);
    btSoftBody& cube = addCube(world, {3, 0, 0});
    for (int i = 0; i < 5; ++i) cube.appendDeformableAnchor(i, chain.getBaseCollider());
    cube.setVelocity(btVector3(btScalar(0.05), 0, 0));
    world.step(30);
    EXPECT_GT(chain.getBaseVel().x(), 0.01);
    EXPECT_GT(chain.getBasePos().x(), 0.005);
}

TEST_F(HeldMultiBody, AMotorsLinkAndTheCubeOnItFallAsleep)
{
    MultiBodyWorld world(m_fem);
    const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.1));
    btMultiBodyLinkCollider& link = addSlider(world, 20, btVector3(0, 0, 1), half, btVector3(0, 0, btScalar(-0.1)));
    world.addConstraint<btMultiBodyJointMotor>(link.m_multiBody, 0, 0, btScalar(1e4));
    link.m_multiBody->setCanSleep(true);
    link.forceActivationState(ACTIVE_TAG);
    btSoftBody& cube = addCube(world, {0, 0, 0.21});
    cube.forceActivationState(ACTIVE_TAG);
    int steps = 0;
    while (cube.isActive() && steps < 900) world.step(), ++steps;
    EXPECT_LT(steps, 900);
    EXPECT_EQ(link.getActivationState(), ISLAND_SLEEPING);
}

}  // namespace
}  // namespace bullet_fem
