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
        m_rebounds.resize(1);
        Rebound& m_rebound = m_rebounds[0];
        m_rebound.m_first = 0;
        m_rebound.m_second = 1;
        m_rebound.m_normal = {0, 0, 1};
        m_rebound.m_speed = 3;
    }

    bool give(double energy)
    {
        m_system.set(m_problem, m_rebounds);
        return m_system.give(m_problem, m_rebounds, energy);
    }

    double energy() const
    {
        double sum = 0;
        for (const RigidProxy& proxy : m_problem.m_rigidProxies) sum += energyOfSphere(proxy);
        return sum;
    }

    double speed(std::size_t k = 0) const { return separationSpeed(m_problem, m_rebounds[k]); }

    ContactProblem m_problem;
    std::vector<Rebound> m_rebounds;
    ReboundSystem m_system;
};

TEST_F(ReboundTest, PartsAtTheSpeedWanted)
{
    EXPECT_TRUE(give(1e3));
    EXPECT_GT(m_rebounds[0].m_impulse, 0);
    EXPECT_NEAR(speed(), 3, 1e-12);
}

TEST_F(ReboundTest, GivesNoMoreThanTheAvailableEnergy)
{
    const double before = energy();
    EXPECT_TRUE(give(0.7));
    EXPECT_NEAR(energy(), before + 0.7, 1e-12);
    EXPECT_LT(speed(), 3);
}

TEST_F(ReboundTest, GivesNothingIfPartingFasterOrWithoutEnergy)
{
    m_rebounds[0].m_speed = 0.01;
    EXPECT_FALSE(give(1e3));
    EXPECT_EQ(m_rebounds[0].m_impulse, 0);
    m_rebounds[0].m_speed = 3;
    const double before = energy();
    give(-1);
    EXPECT_NEAR(energy(), before, 1e-12);
}

// A row of spheres parts as wanted at every contact, where impulses can only push.
TEST_F(ReboundTest, PartsARowAtOnce)
{
    m_problem.m_rigidProxies = {freeSphere(2, {0, 0, 2}, {0, 0, 0.4}), freeSphere(2, {0, 0, 1}, {0, 0, 0.4}),
                                freeSphere(2, {0, 0, 0}, {0, 0, 0.4})};
    m_rebounds.assign(2, m_rebounds[0]);
    m_rebounds[1].m_first = 1;
    m_rebounds[1].m_second = 2;
    m_rebounds[0].m_speed = 1.2;
    m_rebounds[1].m_speed = 0;
    EXPECT_TRUE(give(1e3));
    EXPECT_NEAR(speed(0), 1.2, 1e-8);
    EXPECT_NEAR(speed(1), 0, 1e-8);
    m_rebounds[1].m_speed = -5;  // the contact does not pull
    m_rebounds[0].m_speed = 3;
    EXPECT_TRUE(give(1e3));
    EXPECT_EQ(m_rebounds[1].m_impulse, 0);
    EXPECT_NEAR(speed(0), 3, 1e-8);
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
