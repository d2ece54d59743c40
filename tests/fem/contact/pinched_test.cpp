// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cmath>

#include "fem/scenes/contact_scene.h"

// Nodes pinched between two bodies, with warm starts from a step in which both pressed on them.
namespace bullet_fem
{
namespace
{

constexpr double kMass = 3e3;  // of the ball [kg]; a node of the cube has some tens

// Puts the cube's lower face between a floor and a ball, which is in contact with all its nodes from above.
void pinch(ContactScene& scene, double speed, double guess)
{
    scene.m_settings.m_rounds = 1;
    scene.m_settings.m_sweeps = 50;
    setGravity(scene.m_body, {0, 0, -9.81});
    scene.setVelocity({0, 0, -1});
    scene.m_rigidProxies.resize(2);
    RigidProxy& ball = scene.m_rigidProxies[1];
    makeBall(ball, kMass, 0.5);
    ball.m_center = {0.5, 0.5, 0.5};
    ball.m_linearVelocity = {0, 0, speed};
    ball.m_angularVelocity = {0, 0.5, 0};
    scene.touchLowerFace(0, 0.5);
    for (int k = 0; k < 9; ++k)
    {
        ContactPoint contact = scene.m_contacts[k];
        contact.m_rigidProxy = 1;
        contact.m_normal = {0, 0, -1};
        scene.m_contacts.push_back(contact);
    }
    for (ContactPoint& contact : scene.m_contacts) contact.m_impulse = guess * kMass / 9 * contact.m_normal;
}

}  // namespace

// Contacts that separate have no impulse on either side, closing ones have on both; outer iterations end.
TEST(Pinched, NodesAreOnlyPushed)
{
    for (const double young : {1e4, 1e5, 1e6})
        for (const double speed : {-1.0, 0.05, 1.0})
            for (const double guess : {0.0, 0.5, 2.0})
            {
                SCOPED_TRACE(testing::Message() << young << " " << speed << " " << guess);
                ContactScene scene(young);
                pinch(scene, speed, guess);
                const ContactReport report = scene.solve();
                EXPECT_LT(report.m_rounds, scene.m_settings.m_maxRounds);
                EXPECT_LT(report.m_violation, 2e-4);
                double held = 0;
                for (const ContactPoint& contact : scene.m_contacts)
                {
                    const double normal = dot(contact.m_impulse, contact.m_normal);
                    EXPECT_GE(normal, 0);
                    EXPECT_LE(norm(contact.m_impulse), std::hypot(1, 0.5) * normal * (1 + 1e-9));
                    if (contact.m_rigidProxy == 1) held += contact.m_impulse.z;
                }
                EXPECT_NEAR(scene.m_rigidProxies[1].m_linearVelocity.z, speed - held / kMass, 1e-9 * (1 + guess));
            }
}

}  // namespace bullet_fem
