// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rolling and spinning friction between the lower face of a soft cube and a spinning ball below it.
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

constexpr double kSpinningMass = 300;    // of the ball [kg]
constexpr double kSpinningRadius = 0.5;  // [m]
constexpr double kSpinLever = 0.5;       // [m]
constexpr int kTorsionNodes = 9;

/// Angular momenta of both bodies about the origin [kg m2/s].
struct AngularMomenta
{
    Vec3 m_soft, m_ball;
};

/// Frictionless contacts and one torsional friction row with these coefficients [m]; the parameter is the limit of
/// points for a dense compliance.
class TorsionalRows : public testing::TestWithParam<int>
{
protected:
    TorsionalRows()
    {
        RigidProxy& ball = m_scene.m_rigidProxies[0];
        makeBall(ball, kSpinningMass, kSpinningRadius);
        ball.m_center = {0.5, 0.5, -kSpinningRadius};
        ball.m_linearVelocity = {0, 0, 1};
        ball.m_angularVelocity = {3, -2, 4};
        m_scene.setVelocity({0, 0, -2});
        m_scene.touchLowerFace(0, 0);
        m_scene.m_settings.m_denseLimit = GetParam();
        m_scene.m_settings.m_maxRounds = 60;
        m_scene.m_settings.m_rounds = 60;
        m_scene.m_settings.m_tolerance = 1e-7;
    }

    void addTorsion(double rolling, double spinning)
    {
        const std::vector<Vec3>& x = m_scene.m_body.m_state.m_x;
        Vec3 center;
        for (int node = 0; node < kTorsionNodes; ++node) center += (1.0 / kTorsionNodes) * x[node];
        Mat3 inertia;
        for (int node = 0; node < kTorsionNodes; ++node)
        {
            const Vec3 d = x[node] - center;
            inertia += Mat3::diagonal(dot(d, d)) - outer(d, d);
        }
        TorsionalFriction torsion;
        torsion.m_count = kTorsionNodes;
        for (int node = 0; node < kTorsionNodes; ++node)
        {
            m_scene.m_problem.m_handleNodes.push_back(node);
            m_scene.m_problem.m_handleBlocks.push_back(inverse(inertia) * crossMatrix(x[node] - center));
        }
        torsion.m_friction = {spinning, rolling, rolling};
        torsion.m_lever = kSpinLever;
        m_scene.m_problem.m_torsions = {torsion};
        m_scene.m_problem.m_torsionOf.assign(m_scene.m_contacts.size(), 0);
    }

    const TorsionalFriction& torsion() const { return m_scene.m_problem.m_torsions[0]; }

    double load() const
    {
        double sum = 0;
        for (const ContactPoint& contact : m_scene.m_contacts) sum += dot(contact.m_impulse, contact.m_normal);
        return sum;
    }

    Vec3 patchSpin() const
    {
        Vec3 spin;
        for (int k = 0; k < kTorsionNodes; ++k)
            spin += m_scene.m_problem.m_handleBlocks[k] * velocity(m_scene.m_body)[m_scene.m_problem.m_handleNodes[k]];
        return spin;
    }

    AngularMomenta momenta(const std::vector<Vec3>& v) const
    {
        AngularMomenta sum;
        const BodyState& s = m_scene.m_body.m_state;
        for (std::size_t i = 0; i < v.size(); ++i) sum.m_soft += cross(s.m_x[i], s.m_mass[i] * v[i]);
        const RigidProxy& ball = m_scene.m_rigidProxies[0];
        sum.m_ball = cross(ball.m_center, kSpinningMass * ball.m_linearVelocity) +
                     (0.4 * kSpinningMass * kSpinningRadius * kSpinningRadius) * ball.m_angularVelocity;
        return sum;
    }

    ContactScene m_scene;
};

// Friction against the spin about each axis: 4 rad/s about the normal, and (3, -2) across it.
TEST_P(TorsionalRows, SlipWithTheLoadTimesTheCoefficients)
{
    m_scene.m_contacts.clear();
    m_scene.touchNode(4, 0, 0);  // the middle node; otherwise the normal rows resist the spin
    addTorsion(0.01, 0.02);
    m_scene.solve();
    const Vec3 spin = m_scene.m_rigidProxies[0].m_angularVelocity - patchSpin();
    EXPECT_GT(load(), 300);
    EXPECT_NEAR(torsion().m_impulse.z, 0.02 * load(), 1e-5 * load());
    const double across = std::hypot(spin.x, spin.y);
    EXPECT_NEAR(torsion().m_impulse.x, 0.01 * load() * spin.x / across, 1e-4 * load());
    EXPECT_NEAR(torsion().m_impulse.y, 0.01 * load() * spin.y / across, 1e-4 * load());
    EXPECT_NEAR(std::hypot(torsion().m_impulse.x, torsion().m_impulse.y), 0.01 * load(), 1e-6 * load());
}

TEST_P(TorsionalRows, StickWithinTheirLimits)
{
    addTorsion(10, 10);
    m_scene.solve();
    EXPECT_LT(norm(m_scene.m_rigidProxies[0].m_angularVelocity - patchSpin()), 1e-3);
}

TEST_P(TorsionalRows, KeepTheAngularMomentum)
{
    addTorsion(0.05, 0.1);
    const AngularMomenta before = momenta(m_scene.m_body.m_state.m_v);
    m_scene.solve();
    const AngularMomenta after = momenta(velocity(m_scene.m_body));
    const double size = norm(before.m_soft) + norm(before.m_ball);
    EXPECT_GT(norm(torsion().m_impulse), 1e-3 * size);
    EXPECT_LE(norm(after.m_soft + after.m_ball - before.m_soft - before.m_ball), 1e-12 * size);
}

TEST_P(TorsionalRows, AreNothingWithoutALoad)
{
    addTorsion(10, 10);
    for (ContactPoint& contact : m_scene.m_contacts) contact.m_gap = 1;
    m_scene.solve();
    EXPECT_EQ(norm(torsion().m_impulse), 0);
    EXPECT_NEAR(m_scene.m_rigidProxies[0].m_angularVelocity.z, 4, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(DenseLimits, TorsionalRows, testing::Values(400, 0),
                         [](const auto& suite) { return suite.param > 0 ? "InTurn" : "AtOnce"; });

}  // namespace
}  // namespace bullet_fem
