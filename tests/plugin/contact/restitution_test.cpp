// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kSoftRestitution = 0.6, kFloorRestitution = 1;
constexpr double kRestitution = kSoftRestitution * kFloorRestitution;  // Bullet's rule [-]

class Bounce : public EachWorldWith<int>  // steps per second
{
protected:
    explicit Bounce(const btVector3& gravity = {0, 0, btScalar(-kGravity)}, const btFemSolverInfo& info = {})
        : m_world(worldClass(), info, gravity)
    {
        m_floor = &m_world.addFloorBox();
        m_floor->setRestitution(btScalar(kFloorRestitution));
    }

    btSoftBody& add(btSoftBody* body, double young)
    {
        body->setRestitution(btScalar(kSoftRestitution));
        btFemMaterial material;
        material.m_youngModulus = btScalar(young);
        material.m_stiffnessDamping = btScalar(0.0005);
        m_fem.setMaterial(body, material);
        m_floor->setFriction(0);
        return m_world.addSoft(body);
    }

    // A ball of radius 0.2 m whose lowest point is a single node.
    btSoftBody& addBall(double height)
    {
        btSoftBody* ball = btFemHelpers::createFromTetMesh(m_world.info(), makeSphere(kRadius, 4));
        ball->translate(btVector3(0, 0, btScalar(height)));
        return add(ball, 1e9);
    }

    btSoftBody& addCube(double young, double height)
    {
        return add(btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(height)),
                                           btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)), btScalar(0.1)),
                   young);
    }

    void step() { m_world.step(1, btScalar(m_h)); }

    // Steps until the body has a contact impulse, for a second at most.
    void stepUntilTouched(const btSoftBody& body)
    {
        for (int k = 0; k < value(); ++k)
        {
            step();
            if (impulseOn(m_fem, body).z > 0) return;
        }
    }

    static constexpr double kRadius = 0.2;  // [m]
    const double m_h = 1.0 / value();       // [s]
    FemWorld m_world;
    btFemSoftBodySolver& m_fem = m_world.fem();
    btRigidBody* m_floor = nullptr;
};

class BounceInSpace : public Bounce
{
protected:
    BounceInSpace() : Bounce({0, 0, 0}) {}
};

// A body's mean rebound speed is e times its impact speed, for any material and step.
TEST_P(BounceInSpace, ABodyLeavesAtItsShareOfTheSpeed)
{
    for (const double young : {1e5, 1e7, 1e9})
    {
        SCOPED_TRACE(young);
        btSoftBody& cube = addCube(young, 0.25);
        cube.setVelocity(btVector3(0, 0, -2));
        stepUntilTouched(cube);
        ASSERT_EQ(m_fem.contacts(&cube).size(), 25);
        for (int k = 0; k < value() / 4; ++k) step();
        EXPECT_EQ(m_fem.contacts(&cube).size(), 0);
        EXPECT_NEAR(velocityOf(cube).z, 2 * kRestitution, 0.02 * 2 * kRestitution);
        m_world.deleteSoft(cube);
    }
}

// A stiff body rebounds as a whole: its vibrations, shorter than the step, are damped.
TEST_P(BounceInSpace, AStiffBodyLeavesAtItsShareOfTheSpeed)
{
    btSoftBody& ball = addBall(0.3);
    ball.setVelocity(btVector3(0, 0, -2));
    stepUntilTouched(ball);
    for (int k = 0; k < value() / 4; ++k) step();
    EXPECT_NEAR(velocityOf(ball).z, 2 * kRestitution, 0.05 * 2 * kRestitution);
    EXPECT_LT(std::hypot(velocityOf(ball).x, velocityOf(ball).y), 0.02);
}

// The apex is e^2 times the height, up to the phase of the impact within the step: an error of order g h / v.
TEST_P(Bounce, AStiffBallRisesToTheSquareOfItsRestitution)
{
    constexpr double kDrop = 1;  // initial height of its lowest node [m]
    btSoftBody& ball = addBall(kDrop + kRadius);
    stepUntilTouched(ball);
    double apex = 0;
    for (int k = 0; k < value() / 2; ++k)
    {
        step();
        apex = std::max(apex, lowestHeight(ball));
    }
    const double expected = kRestitution * kRestitution * kDrop, speed = std::sqrt(2 * kGravity * kDrop);
    EXPECT_NEAR(apex, expected, (0.04 + 3 * kGravity * m_h / speed) * expected);
}

class BounceOfTheStep : public Bounce
{
protected:
    BounceOfTheStep() : Bounce({0, 0, btScalar(-kGravity)}, withoutElasticRebound()) {}

    static btFemSolverInfo withoutElasticRebound()
    {
        btFemSolverInfo info;
        info.m_elasticRebound = false;
        return info;
    }
};

TEST_P(BounceOfTheStep, StiffBallStaysWithoutRestitution)
{
    btSoftBody& ball = addBall(1 + kRadius);
    ball.setRestitution(0);
    stepUntilTouched(ball);
    for (int k = 0; k < value() / 2; ++k)
    {
        step();
        EXPECT_LT(lowestHeight(ball), 0.01);
    }
}

// Momentum changes by the reported impulses and the weight in each step, those of the rebound, too.
TEST_P(Bounce, ContactsAndTouchesReportTheRebound)
{
    for (const double young : {1e5, 1e7})
    {
        SCOPED_TRACE(young);
        btSoftBody& cube = addCube(young, 0.3);
        cube.setVelocity(btVector3(0, 0, -3));
        double mostImpulse = 0;
        for (int k = 0; k < value() / 2; ++k)
        {
            const Vec3 before = massOf(cube) * velocityOf(cube);
            step();
            const Vec3 gained = massOf(cube) * velocityOf(cube) - before + Vec3{0, 0, massOf(cube) * kGravity * m_h};
            const Vec3 reported = impulseOn(m_fem, cube);
            EXPECT_LT(norm(gained - reported), 1e-4 * 3 * massOf(cube)) << k;
            const btAlignedObjectArray<btFemTouch>& touches = m_fem.touches(&cube);
            Vec3 touched;
            for (int t = 0; t < touches.size(); ++t) touched += vec3(touches[t].m_impulse);
            EXPECT_LT(norm(touched - reported), 1e-5 * 3 * massOf(cube)) << k;
            mostImpulse = std::max(mostImpulse, norm(reported));
        }
        EXPECT_GT(mostImpulse, 0.1 * massOf(cube));
        m_world.deleteSoft(cube);
    }
}

// Restitution does not keep a resting body from resting.
TEST_P(Bounce, ABodyComesToRest)
{
    btSoftBody& cube = addCube(1e7, 0.25);
    for (int k = 0; k < 3 * value(); ++k) step();
    for (int k = 0; k < value(); ++k)
    {
        step();
        EXPECT_LT(fastestNode(cube), 1e-3);
    }
    EXPECT_NEAR(m_fem.contactForce(&cube, m_floor).z(), massOf(cube) * kGravity, 1e-3 * massOf(cube) * kGravity);
}

std::string rateName(int stepsPerSecond)
{
    return std::to_string(stepsPerSecond);
}

INSTANTIATE_TEST_SUITE_P(Contact, Bounce, testing::Combine(eachWorld(), testing::Values(60, 240)),
                         nameOfWorldWith(rateName));
INSTANTIATE_TEST_SUITE_P(Contact, BounceOfTheStep, testing::Combine(eachWorld(), testing::Values(60, 240)),
                         nameOfWorldWith(rateName));
INSTANTIATE_TEST_SUITE_P(Contact, BounceInSpace, testing::Combine(eachWorld(), testing::Values(60, 240)),
                         nameOfWorldWith(rateName));

class SpringyFloor : public Bounce
{
};

// Bullet's contact stiffness of a static object: n points share the weight, so that they penetrate by F / (n k).
TEST_P(SpringyFloor, YieldsByTheForceOverTheStiffnessOfItsPoints)
{
    constexpr double kStiffness = 2e3, kDamping = 100;  // of each point [N/m], [N s/m]
    m_floor->setContactStiffnessAndDamping(btScalar(kStiffness), btScalar(kDamping));
    btSoftBody& cube = addCube(1e8, 0.2);
    for (int k = 0; k < 4 * value(); ++k) step();
    const double weight = massOf(cube) * kGravity;
    const btAlignedObjectArray<btFemContact>& contacts = m_fem.contacts(&cube);
    ASSERT_EQ(contacts.size(), 25);
    double depth = 0, force = 0;
    for (int k = 0; k < 25; ++k)
    {
        depth -= contacts[k].m_gap / 25;
        force += contacts[k].m_normalImpulse / m_h;
        EXPECT_NEAR(contacts[k].m_normalImpulse / m_h, -kStiffness * contacts[k].m_gap, 1e-3 * weight);
    }
    EXPECT_NEAR(depth, weight / (25 * kStiffness), 0.005 * weight / (25 * kStiffness));
    EXPECT_NEAR(force, weight, 1e-3 * weight);
}

INSTANTIATE_TEST_SUITE_P(Contact, SpringyFloor, testing::Combine(eachWorld(), testing::Values(60, 240)),
                         nameOfWorldWith(rateName));

}  // namespace
}  // namespace bullet_fem
