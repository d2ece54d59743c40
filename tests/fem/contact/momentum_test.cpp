// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Momentum lost by a soft body equals that gained by its rigid proxies, to rounding, for any approximation of the
// compliance.
#include <gtest/gtest.h>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

struct Momenta
{
    Vec3 m_linear, m_angular;                    // about the origin
    double m_linearSize = 0, m_angularSize = 0;  // sums of magnitudes

    void add(const Vec3& x, const Vec3& p)
    {
        m_linear += p;
        m_angular += cross(x, p);
        m_linearSize += norm(p);
        m_angularSize += norm(x) * norm(p);
    }
};

class MomentumExchange : public testing::TestWithParam<double>
{
protected:
    // A spinning ball moves up against the lower face of the soft cube, which moves down and sideways.
    MomentumExchange()
    {
        RigidProxy& ball = m_scene.m_rigidProxies[0];
        m_mass = GetParam() * m_scene.softMass();
        makeBall(ball, m_mass, 0.5);
        ball.m_center = {0.6, 0.3, -0.5};
        ball.m_linearVelocity = {-0.5, 0.3, 1};
        ball.m_angularVelocity = {3, -2, 4};
        m_scene.setVelocity({1, -0.5, -2});
        m_scene.touchLowerFace(0, 0.5);
        // The default tolerance of a step: momentum must not depend on it.
        m_scene.m_settings.m_step.m_tolerance = 1e-3;
        m_scene.m_settings.m_rounds = 2;
        m_scene.m_settings.m_sweeps = 20;
    }

    Momenta momenta(const std::vector<Vec3>& v) const
    {
        Momenta sum;
        const BodyState& s = m_scene.m_body.m_state;
        for (std::size_t i = 0; i < v.size(); ++i) sum.add(s.m_x[i], s.m_mass[i] * v[i]);
        const RigidProxy& ball = m_scene.m_rigidProxies[0];
        sum.add(ball.m_center, m_mass * ball.m_linearVelocity);
        const Vec3 spin = 0.4 * m_mass * 0.25 * ball.m_angularVelocity;
        sum.m_angular += spin;
        sum.m_angularSize += norm(spin);
        return sum;
    }

    ContactScene m_scene;
    double m_mass = 0;
};

TEST_P(MomentumExchange, KeepsLinearAndAngularMomentum)
{
    const Momenta before = momenta(m_scene.m_body.m_state.m_v);
    m_scene.solve();
    const Momenta after = momenta(velocity(m_scene.m_body));
    EXPECT_GT(norm(m_scene.totalImpulse()), 0.1 * std::min(m_mass, m_scene.softMass()));
    EXPECT_LE(norm(after.m_linear - before.m_linear), 1e-12 * before.m_linearSize);
    EXPECT_LE(norm(after.m_angular - before.m_angular), 1e-12 * before.m_angularSize);
}

TEST_P(MomentumExchange, KeepsItFromAGuessToo)
{
    for (ContactPoint& contact : m_scene.m_contacts) contact.m_impulse = {-5, 2, 30};
    const Momenta before = momenta(m_scene.m_body.m_state.m_v);
    m_scene.solve();
    const Momenta after = momenta(velocity(m_scene.m_body));
    EXPECT_LE(norm(after.m_linear - before.m_linear), 1e-12 * (before.m_linearSize + 9 * 30));
    EXPECT_LE(norm(after.m_angular - before.m_angular), 1e-12 * (before.m_angularSize + 9 * 30));
}

TEST_P(MomentumExchange, GivesTheSumOfItsImpulsesToBothSides)
{
    const Vec3 ballBefore = m_scene.m_rigidProxies[0].m_linearVelocity;
    m_scene.solve();
    const Vec3 J = m_scene.totalImpulse();
    const Vec3 ballGain = m_mass * (m_scene.m_rigidProxies[0].m_linearVelocity - ballBefore);
    EXPECT_LE(norm(ballGain + J), 1e-12 * (norm(J) + m_mass * norm(ballBefore)));
    Vec3 softGain;
    for (std::size_t i = 0; i < m_scene.m_body.m_state.m_v.size(); ++i)
        softGain += m_scene.m_body.m_state.m_mass[i] * (velocity(m_scene.m_body)[i] - m_scene.m_body.m_state.m_v[i]);
    EXPECT_LE(norm(softGain - J), 1e-12 * (norm(J) + m_scene.softMass() * 2.3));
}

// Friction and inelastic impact only dissipate energy.
TEST_P(MomentumExchange, NeverApproachesAfterwards)
{
    m_scene.m_settings.m_step.m_tolerance = 1e-9;
    m_scene.m_settings.m_rounds = 10;
    m_scene.m_settings.m_sweeps = 1000;
    m_scene.solve();
    for (const ContactPoint& contact : m_scene.m_contacts)
    {
        EXPECT_GE(dot(contact.m_normal, m_scene.relativeVelocity(contact)), -1e-4);
        EXPECT_LE(dot(contact.m_impulse - contact.m_impulse.z * contact.m_normal, m_scene.relativeVelocity(contact)),
                  1e-6 * m_mass);
    }
}

INSTANTIATE_TEST_SUITE_P(MassRatios, MomentumExchange, testing::Values(1e-3, 0.1, 1., 10., 1e3),
                         [](const auto& suite)
                         {
                             const double ratio = suite.param;
                             const std::string name = ratio < 1 ? "1to" + std::to_string(std::lround(1 / ratio))
                                                                : std::to_string(std::lround(ratio)) + "to1";
                             return "Rigid" + name;
                         });

// A central stiff impact ends in the common velocity v' = (m1 v1 + m2 v2) / (m1 + m2), with an error of rho L^2 / (E
// h^2).
TEST(InelasticImpact, EndsInTheCommonVelocity)
{
    for (const double ratio : {0.1, 1.0, 10.0})
    {
        ContactScene scene(1e10);
        const double m1 = scene.softMass(), m2 = ratio * m1;
        scene.setVelocity({0, 0, -2});
        makeBall(scene.m_rigidProxies[0], m2, 0.5);
        scene.m_rigidProxies[0].m_center = {0.5, 0.5, -0.5};
        scene.m_rigidProxies[0].m_linearVelocity = {0, 0, 3};
        scene.touchNode(4, 0, 0);
        scene.solve();
        const double common = (m2 * 3 - m1 * 2) / (m1 + m2);
        EXPECT_NEAR(scene.m_rigidProxies[0].m_linearVelocity.z, common, 0.02) << ratio;
        for (const Vec3& v : velocity(scene.m_body)) EXPECT_NEAR(v.z, common, 0.02) << ratio;
    }
}

// A slider accepts impulses along its axis only.
TEST(Slider, TakesImpulsesAlongItsAxisOnly)
{
    ContactScene scene;
    scene.setVelocity({1, 2, -2});
    scene.m_rigidProxies[0].m_inverseMass = {0, 0, 1.0 / 500};
    scene.touchLowerFace(0, 0.5);
    scene.solve();
    EXPECT_EQ(scene.m_rigidProxies[0].m_linearVelocity.x, 0);
    EXPECT_EQ(scene.m_rigidProxies[0].m_linearVelocity.y, 0);
    EXPECT_EQ(norm(scene.m_rigidProxies[0].m_angularVelocity), 0);
    EXPECT_NEAR(500 * scene.m_rigidProxies[0].m_linearVelocity.z, -scene.totalImpulse().z,
                1e-12 * scene.totalImpulse().z);
}

}  // namespace
}  // namespace bullet_fem
