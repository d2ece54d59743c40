// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact/rebound.h"

#include <gtest/gtest.h>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

RigidProxy freeSphere(double mass, const Vec3& center, const Vec3& velocity)
{
    RigidProxy proxy;
    proxy.m_inverseMass = {1 / mass, 1 / mass, 1 / mass};
    proxy.m_inverseInertia = Mat3::diagonal(1 / (0.4 * mass));
    proxy.m_center = center;
    proxy.m_linearVelocity = velocity;
    return proxy;
}

double energyOfSphere(const RigidProxy& proxy)
{
    const double mass = 1 / proxy.m_inverseMass.x;
    return 0.5 * mass * dot(proxy.m_linearVelocity, proxy.m_linearVelocity) +
           0.2 * mass * dot(proxy.m_angularVelocity, proxy.m_angularVelocity);
}

class ReboundTest : public testing::Test
{
protected:
    ReboundTest()
    {
        m_problem.m_rigidProxies = {freeSphere(2, {0, 0.3, 1}, {0.1, 0, 0.5}), freeSphere(5, {0, 0, -1}, {0, 0, 0.4})};
        m_rebound.m_first = 0;
        m_rebound.m_second = 1;
        m_rebound.m_normal = {0, 0, 1};
        m_rebound.m_speed = 3;
        m_rebound.m_energy = 1e3;
    }

    double energy() const
    {
        return energyOfSphere(m_problem.m_rigidProxies[0]) + energyOfSphere(m_problem.m_rigidProxies[1]);
    }

    double speed() const
    {
        return dot(m_rebound.m_normal, m_problem.m_rigidProxies[0].velocityAt(m_rebound.m_point) -
                                           m_problem.m_rigidProxies[1].velocityAt(m_rebound.m_point));
    }

    ContactProblem m_problem;
    Rebound m_rebound;
};

TEST_F(ReboundTest, PartsAtTheSpeedWanted)
{
    EXPECT_GT(giveRebound(m_problem, m_rebound).z, 0);
    EXPECT_NEAR(speed(), 3, 1e-12);
}

TEST_F(ReboundTest, GivesNoMoreThanTheAvailableEnergy)
{
    m_rebound.m_energy = 0.7;
    const double before = energy();
    giveRebound(m_problem, m_rebound);
    EXPECT_NEAR(energy(), before + 0.7, 1e-12);
    EXPECT_LT(speed(), 3);
}

TEST_F(ReboundTest, GivesNothingIfPartingFasterOrWithoutEnergy)
{
    m_rebound.m_speed = 0.01;
    EXPECT_EQ(norm(giveRebound(m_problem, m_rebound)), 0);
    m_rebound.m_speed = 3;
    m_rebound.m_energy = -1;
    EXPECT_NEAR(norm(giveRebound(m_problem, m_rebound)), 0, 1e-15);
}

// One component with the momenta of a rigid body; an added rigid motion is included.
TEST(WholeMotion, MatchesTheMomenta)
{
    ContactScene scene;
    Body& body = scene.m_body;
    addWholeMotion(body, 0, {0.2, 0, 0}, {1, 2, 3}, {0.3, -0.2, 0.5});
    const RigidProxy whole = wholeMotion(body, 0);
    EXPECT_NEAR(norm(whole.m_angularVelocity - Vec3{0.3, -0.2, 0.5}), 0, 1e-12);
    EXPECT_NEAR(norm(whole.velocityAt({0.2, 0, 0}) - Vec3{1, 2, 3}), 0, 1e-12);
    EXPECT_NEAR(norm(whole.m_linearVelocity - whole.m_inverseMass.x * linearMomentum(body.m_state)), 0, 1e-12);
    body.m_state.m_fixed[0] = 1;
    EXPECT_FALSE(wholeMotion(body, 0).canMove());
}

}  // namespace
}  // namespace bullet_fem
