// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "plugin/scenes/multibody_scene.h"

namespace bullet_fem
{
namespace
{

TEST_F(MultiBodyWorldTest, HitPendulumReceivesTheAngularMomentum)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBodyLinkCollider& link = addPendulum(world, 30, btVector3(btScalar(0.1), btScalar(0.3), btScalar(0.5)));
    btSoftBody& cube = addCube(world, {-0.35, 0, -0.7}, 0.4, 0.3);
    cube.setVelocity(btVector3(3, 0, btScalar(0.5)));
    const double start = motionOf(cube).m_angular.y;
    double worst = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        const double now = motionOf(cube).m_angular.y + motionOfLinks(*link.m_multiBody).m_angular.y;
        worst = std::max(worst, std::fabs(now - start));
    }
    EXPECT_GT(std::fabs(motionOfLinks(*link.m_multiBody).m_angular.y), 0.2 * std::fabs(start));
    EXPECT_LT(worst, 2e-5 * std::fabs(start));
}

// A rebound knows the joints of links, not Bullet's constraints of rigid bodies.
class PendulumWithoutRebound : public MultiBodyWorldTest
{
protected:
    PendulumWithoutRebound() : MultiBodyWorldTest(withoutElasticRebound()) {}

    static btFemSolverInfo withoutElasticRebound()
    {
        btFemSolverInfo info;
        info.m_elasticRebound = false;
        return info;
    }
};

// The reference is an equal pendulum as a rigid body on Bullet's hinge, which is solved after the soft body's push.
TEST_F(PendulumWithoutRebound, APendulumTurnsLikeARigidBodyOnAHinge)
{
    const btVector3 half(btScalar(0.1), btScalar(0.3), btScalar(0.5));
    const auto hit = [&](MultiBodyWorld& world)
    {
        btSoftBody& cube = addCube(world, {-0.35, 0, -0.7}, 0.4, 0);
        cube.setVelocity(btVector3(3, 0, 0));
        world.step(45);
    };
    MultiBodyWorld links(m_fem, kNoGravity);
    const btMultiBodyLinkCollider& link = addPendulum(links, 30, half);
    hit(links);

    MultiBodyWorld hinged(m_fem, kNoGravity);
    RigidSettings settings;
    settings.m_mass = 30;
    settings.m_transform = at(0, 0, -half.z());
    btRigidBody& beam = hinged.addRigid(new btBoxShape(half), settings);
    btHingeConstraint hinge(beam, btVector3(0, 0, half.z()), btVector3(0, 1, 0));
    hinged.world().addConstraint(&hinge);
    hit(hinged);
    hinged.world().removeConstraint(&hinge);
    const double spin = beam.getAngularVelocity().y();
    EXPECT_GT(std::fabs(spin), 1);
    EXPECT_NEAR(link.m_multiBody->getJointVel(0), spin, 0.05 * std::fabs(spin));
}

class FastLink : public MultiBodyWorldTest, public ::testing::WithParamInterface<std::pair<double, bool>>
{
};

// A plate that moves farther in a step than the thickness of it and the cube; on a slider along x, or on a hinge 2 m
// above.
TEST_P(FastLink, IsStoppedByACubeAndKeepsMomentumAlongItsJoint)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    const double speed = GetParam().first;
    const bool hinged = GetParam().second;
    const btVector3 half(btScalar(0.02), btScalar(0.3), btScalar(0.3)), arm(0, 0, 2);
    const double mass = 20, inertia = boxInertia(btScalar(mass), half).y() + mass * 4;
    auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
    if (hinged)
        body->setupRevolute(0, btScalar(mass), boxInertia(btScalar(mass), half), -1, kNoTurn, btVector3(0, 1, 0), arm,
                            -arm, false);
    else
        body->setupPrismatic(0, btScalar(mass), boxInertia(btScalar(mass), half), -1, kNoTurn, btVector3(1, 0, 0),
                             btVector3(0, 0, 0), btVector3(0, 0, 0), false);
    btMultiBodyLinkCollider& link = world.addCollider(world.addMultiBody(body), 0, new btBoxShape(half));
    body->setJointPos(0, hinged ? btScalar(0.6) : btScalar(-1.37));
    body->setJointVel(0, btScalar(hinged ? -0.5 * speed : speed));
    btSoftBody& cube = addCube(world, {0, 0, 0}, 0.4);
    const auto momentum = [&]  // along the slider, or about the hinge
    {
        const Motion soft = motionOf(cube);
        const double joint = body->getJointVel(0);
        return hinged ? soft.m_angular.y - 2 * soft.m_linear.x + inertia * joint : soft.m_linear.x + mass * joint;
    };
    const double start = momentum();
    double worst = 0;
    for (int k = 0; k < 40; ++k)
    {
        world.step();
        worst = std::max(worst, std::fabs(momentum() - start) / std::fabs(start));
        ASSERT_TRUE(allFinite(cube));
    }
    EXPECT_GT(velocityOf(cube).x, 0.05 * speed);
    EXPECT_LT(std::fabs(body->getJointVel(0)), 0.6 * (hinged ? 0.5 : 1) * speed);
    EXPECT_LT(worst, 1e-5);
    EXPECT_LT(link.getWorldTransform().getOrigin().x(), centerOf(cube).x + 0.2);
}

INSTANTIATE_TEST_SUITE_P(Speeds, FastLink,
                         ::testing::Values(std::pair(10.0, false), std::pair(40.0, false), std::pair(80.0, false),
                                           std::pair(10.0, true), std::pair(20.0, true), std::pair(25.0, true)),
                         [](const auto& speed) {
                             return (speed.param.second ? "hinge" : "slider") +
                                    std::to_string(static_cast<int>(speed.param.first));
                         });

struct Chain
{
    const char* m_name;
    btMultibodyLink::eFeatherstoneJointType m_joint;
};

class FreeChain : public MultiBodyWorldTest, public ::testing::WithParamInterface<Chain>
{
protected:
    static constexpr btScalar kMass = 15;

    // Three boxes in a row along x in free space, the middle one as base.
    btMultiBody& addChain(MultiBodyWorld& world)
    {
        const btVector3 half(btScalar(0.25), btScalar(0.3), btScalar(0.1));
        const btVector3 inertia = boxInertia(kMass, half), axis(0, 1, 0);
        auto* body = new btMultiBody(2, kMass, inertia, false, false);
        for (int k = 0; k < 2; ++k)
        {
            const btVector3 arm((k == 0 ? 1 : -1) * btScalar(0.3), 0, 0);
            switch (GetParam().m_joint)
            {
                case btMultibodyLink::eRevolute:
                    body->setupRevolute(k, kMass, inertia, -1, kNoTurn, axis, arm, arm);
                    break;
                case btMultibodyLink::ePrismatic:
                    body->setupPrismatic(k, kMass, inertia, -1, kNoTurn, btVector3(0, 0, 1), arm, arm, true);
                    break;
                case btMultibodyLink::eSpherical:
                    body->setupSpherical(k, kMass, inertia, -1, kNoTurn, arm, arm, true);
                    break;
                case btMultibodyLink::ePlanar:
                    body->setupPlanar(k, kMass, inertia, -1, kNoTurn, axis, 2 * arm, true);
                    break;
                default:
                    body->setupFixed(k, kMass, inertia, -1, kNoTurn, arm, arm);
            }
        }
        world.addMultiBody(body);
        for (int k = -1; k < 2; ++k) world.addCollider(*body, k, new btBoxShape(half));
        return *body;
    }
};

// The cube covers the seam between the base and a link, and hits eccentrically. Bullet's steps of joint coordinates
// conserve momentum to first order in the step only, so the oracle is the momentum after Bullet's part.
TEST_P(FreeChain, KeepsAllMomentaWhenHitOnTwoLinksAtOnce)
{
    MultiBodyWorld world(m_fem, kNoGravity);
    btMultiBody& chain = addChain(world);
    btSoftBody& cube = addCube(world, {0.3, 0.1, 0.32}, 0.4, 0.5);
    cube.setVelocity(btVector3(btScalar(0.5), 0, -3));
    const Motion start = motionOf(cube);
    const auto whole = [&]
    {
        Motion sum = motionOf(cube);
        sum += motionOfLinks(chain);
        return sum;
    };
    std::pair<decltype(whole), Motion> moved{whole, {}};
    world.world().setInternalTickCallback(
        [](btDynamicsWorld* of, btScalar)
        {
            auto& seen = *static_cast<decltype(moved)*>(of->getWorldUserInfo());
            seen.second = seen.first();
        },
        &moved);
    double linear = 0, angular = 0, given = 0;
    int most = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        const Motion now = whole();
        linear = std::max(linear, norm(now.m_linear - moved.second.m_linear));
        angular = std::max(angular, norm(now.m_angular - moved.second.m_angular));
        given = std::max(given, norm(motionOfLinks(chain).m_linear));
        most = std::max(most, static_cast<int>(m_fem.touches(&cube).size()));
        ASSERT_TRUE(allFinite(cube));
        ASSERT_LE(now.m_energy, 1.001 * start.m_energy);
    }
    EXPECT_GE(most, 2);
    EXPECT_GT(given, 0.2 * norm(start.m_linear));
    EXPECT_LT(linear, 1e-5 * norm(start.m_linear));
    EXPECT_LT(angular, 1e-5 * norm(start.m_linear));
}

INSTANTIATE_TEST_SUITE_P(Joints, FreeChain,
                         ::testing::Values(Chain{"fixed", btMultibodyLink::eFixed},
                                           Chain{"revolute", btMultibodyLink::eRevolute},
                                           Chain{"prismatic", btMultibodyLink::ePrismatic},
                                           Chain{"spherical", btMultibodyLink::eSpherical},
                                           Chain{"planar", btMultibodyLink::ePlanar}),
                         [](const auto& chain) { return chain.param.m_name; });

}  // namespace
}  // namespace bullet_fem
