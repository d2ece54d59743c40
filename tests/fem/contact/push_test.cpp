// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Position correction of penetrations, contacts of fixed nodes, and contacts with a stale factor.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

// --- Penetration ---

TEST(Penetration, IsTakenBackByAShareWithoutVelocity)
{
    ContactScene scene;
    scene.touchNode(4, -0.01, 0.5);
    scene.m_settings.m_pushFraction = 0.25;
    scene.solve();
    EXPECT_LE(norm(scene.m_contacts[0].m_impulse), 1e-9);
    finishStep(scene.m_body, scene.m_settings.m_step);
    EXPECT_NEAR(scene.m_body.m_state.m_x[4].z, 0.0025, 1e-5 * 0.0025);
    for (const Vec3& v : scene.m_body.m_state.m_v) EXPECT_LE(norm(v), 1e-12);
}

TEST(Penetration, IsTakenBackNoFasterThanAllowed)
{
    ContactScene scene;
    scene.touchNode(4, -1, 0);
    scene.m_settings.m_maxPushVelocity = 0.3;
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);
    EXPECT_NEAR(scene.m_body.m_state.m_x[4].z, 0.3 / 60, 1e-5 * 0.3 / 60);
}

TEST(Penetration, IsLeftAloneWithinTheSlop)
{
    ContactScene scene;
    scene.touchNode(4, -0.01, 0);
    scene.m_contacts[0].m_slop = 0.01;
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);
    EXPECT_LE(std::abs(scene.m_body.m_state.m_x[4].z), 1e-15);

    scene.m_contacts[0].m_gap = -0.014;
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);
    EXPECT_NEAR(scene.m_body.m_state.m_x[4].z, 0.2 * 0.004, 1e-5 * 0.004);
}

// A penetration below the tolerance of the correction sweeps, 1e-4 of the displacement by loads in a step, is left.
TEST(Penetration, IsLeftAloneBelowTheSweepTolerance)
{
    const double step = 1.0 / 60, acceleration = 10;
    const double negligible = 1e-4 * acceleration * step * step / 0.2;
    const auto pushed = [&](double depth)
    {
        ContactScene scene;
        const std::vector<double>& mass = scene.m_body.m_state.m_mass;
        for (std::size_t i = 0; i < mass.size(); ++i) scene.m_body.m_loads.m_force[i] = {mass[i] * acceleration, 0, 0};
        scene.touchNode(4, -depth, 0);
        scene.solve();
        finishStep(scene.m_body, scene.m_settings.m_step);
        return scene.m_body.m_state.m_x[4].z;
    };
    EXPECT_LE(std::abs(pushed(0.95 * negligible)), 1e-15);
    EXPECT_NEAR(pushed(1.05 * negligible), 0.2 * 1.05 * negligible, 1e-2 * negligible);
}

// A body that separates faster than the correction is not corrected.
TEST(Penetration, IsNotTakenBackTwice)
{
    ContactScene scene;
    scene.setVelocity({0, 0, 1});
    scene.touchNode(4, -0.01, 0);
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);
    EXPECT_NEAR(scene.m_body.m_state.m_x[4].z, 1.0 / 60, 1e-12);
}

// Both sides move, together by the requested share, and neither keeps a velocity.
TEST(Penetration, IsSharedWithAFreeObstacle)
{
    ContactScene scene;
    makeBall(scene.m_rigidProxies[0], 100, 0.5);
    scene.m_rigidProxies[0].m_center = {0.5, 0.5, -0.5};
    scene.touchNode(4, -0.01, 0);
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);
    const double pushed = scene.m_rigidProxies[0].m_pushLinear.z / 60;
    EXPECT_LT(pushed, 0);
    EXPECT_NEAR(scene.m_body.m_state.m_x[4].z - pushed, 0.002, 1e-5 * 0.002);
    EXPECT_LE(norm(scene.m_rigidProxies[0].m_linearVelocity), 1e-12);
    EXPECT_LE(norm(scene.m_body.m_state.m_v[4]), 1e-12);
}

// --- Nodes without compliance ---

TEST(FixedContact, IsIgnoredAgainstAStaticObstacle)
{
    ContactScene scene;
    scene.m_body.m_state.m_fixed[4] = 1;
    scene.m_body.m_loads.m_targetVelocity[4] = {0, 0, -1};
    scene.touchNode(4, -0.1, 0.5);
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);
    EXPECT_EQ(norm(scene.m_contacts[0].m_impulse), 0);
    EXPECT_EQ(scene.m_body.m_state.m_v[4].z, -1);
}

// A moving pinned node acts as a kinematic body: the ball takes its velocity.
TEST(FixedContact, PushesAFreeObstacle)
{
    ContactScene scene;
    scene.m_body.m_state.m_fixed[4] = 1;
    scene.m_body.m_loads.m_targetVelocity[4] = {0, 0, -1};
    RigidProxy& ball = scene.m_rigidProxies[0];
    makeBall(ball, 10, 0.5);
    ball.m_center = {0.5, 0.5, -0.5};
    scene.touchNode(4, 0, 0);
    scene.solve();
    EXPECT_NEAR(scene.m_contacts[0].m_impulse.z, 10, 1e-12 * 10);
    EXPECT_NEAR(ball.m_linearVelocity.z, -1, 1e-12);
}

// A node that was fixed when the factor was made, and is free now, has no compliance in W; the contact law is fulfilled
// by the outer iterations.
TEST(FixedContact, HoldsForANodeReleasedSinceTheFactor)
{
    ContactScene scene;
    FactorInput input = scene.m_body.m_model->factorInput();
    input.m_fixed[4] = 1;
    const auto model = BodyModel::create(scene.m_body.m_model->sharedShape(), input);
    scene.m_body.setModel(model);
    scene.m_cache = makeComplianceCache(model);
    scene.setVelocity({0, 0, -2});
    scene.touchNode(4, 0, 0);
    scene.m_settings.m_rounds = 10;
    scene.solve();
    EXPECT_GT(scene.m_contacts[0].m_impulse.z, 0);
    EXPECT_NEAR(scene.relativeVelocity(scene.m_contacts[0]).z, 0, 0.02);  // 1 % of the initial velocity
}

// --- A stale factor: W is wrong, and the contact law still holds ---

struct Staleness
{
    const char* m_name;
    double m_massFactor, m_stepFactor;
};

void PrintTo(const Staleness& staleness, std::ostream* out)
{
    *out << staleness.m_name;
}

class StaleContact : public testing::TestWithParam<Staleness>
{
};

TEST_P(StaleContact, HoldsTheBodyAllTheSame)
{
    ContactScene scene;
    for (double& m : scene.m_body.m_state.m_mass) m *= GetParam().m_massFactor;
    scene.m_settings.m_step.m_step *= GetParam().m_stepFactor;
    scene.setVelocity({0.5, 0, -2});
    scene.touchLowerFace(0, 0.3);
    scene.m_settings.m_maxRounds = 100;
    scene.m_settings.m_tolerance = 1e-5;
    scene.solve();
    for (const ContactPoint& contact : scene.m_contacts)
    {
        EXPECT_GT(contact.m_impulse.z, 0);
        EXPECT_NEAR(scene.relativeVelocity(contact).z, 0, 2e-3);  // of 2 m/s
        EXPECT_LE(std::hypot(contact.m_impulse.x, contact.m_impulse.y), 0.3 * contact.m_impulse.z * (1 + 1e-12));
    }
}

// A W whose elastic part is too stiff by sixteen stays so in the next step: the scale found by the outer iterations is
// kept.
TEST(StaleFactorContact, LearnsForTheNextStep)
{
    ContactScene scene;
    scene.m_settings.m_step.m_step *= 0.25;
    int rounds[2];
    for (int& r : rounds)
    {
        scene.m_contacts.clear();
        scene.setVelocity({0, 0, -2});
        scene.touchLowerFace(0, 0.3);
        scene.m_settings.m_tolerance = 1e-2;
        r = scene.solve().m_rounds;
    }
    EXPECT_LT(rounds[1], rounds[0]);
}

INSTANTIATE_TEST_SUITE_P(Factors, StaleContact,
                         testing::Values(Staleness{"Fresh", 1, 1}, Staleness{"MassTenth", 0.1, 1},
                                         Staleness{"MassTimesTen", 10, 1}, Staleness{"StepQuarter", 1, 0.25},
                                         Staleness{"StepTimesFour", 1, 4}),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

}  // namespace
}  // namespace bullet_fem
