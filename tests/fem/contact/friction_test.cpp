// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Coulomb's disc, and the invariance of contact under rotation of the scene.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/scenes/contact_scene.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

Vec3 normalPart(const Vec3& a, const Vec3& n)
{
    return dot(a, n) * n;
}

// --- Coulomb's disc ---

class Sliding : public testing::TestWithParam<int>  // direction in the plane [degrees]
{
protected:
    Vec3 direction() const
    {
        const double angle = GetParam() * kPi / 180;
        return {std::cos(angle), std::sin(angle), 0};
    }
};

TEST_P(Sliding, FrictionIsMuTimesTheNormalAgainstTheSlidingVelocity)
{
    ContactScene scene;
    scene.setVelocity(Vec3{0, 0, -1} + 5 * direction());
    scene.touchLowerFace(0, 0.3);
    scene.solve();
    for (const ContactPoint& contact : scene.m_contacts)
    {
        const Vec3 J = contact.m_impulse, v = scene.relativeVelocity(contact), n = contact.m_normal;
        const Vec3 friction = J - normalPart(J, n), sliding = v - normalPart(v, n);
        EXPECT_NEAR(norm(friction), 0.3 * J.z, 1e-12 * J.z);
        EXPECT_LE(norm(friction * (1 / norm(friction)) + sliding * (1 / norm(sliding))), 1e-5);
    }
}

TEST_P(Sliding, ANodeAloneSlidesAgainstItsVelocity)
{
    ContactScene scene;
    scene.setVelocity(Vec3{0, 0, -1} + 5 * direction());
    scene.touchNode(2, 0, 0.3);  // a corner, whose compliance prefers some directions
    scene.solve();
    const Vec3 J = scene.m_contacts[0].m_impulse, v = scene.relativeVelocity(scene.m_contacts[0]);
    const Vec3 friction = {J.x, J.y, 0}, sliding = {v.x, v.y, 0};
    EXPECT_NEAR(norm(friction), 0.3 * J.z, 1e-12 * J.z);
    EXPECT_LE(norm(friction * (1 / norm(friction)) + sliding * (1 / norm(sliding))), 1e-5);
}

TEST_P(Sliding, EnoughFrictionSticks)
{
    ContactScene scene;
    scene.setVelocity(Vec3{0, 0, -1} + 0.2 * direction());
    scene.touchLowerFace(0, 2);
    scene.solve();
    for (const ContactPoint& contact : scene.m_contacts)
    {
        const Vec3 J = contact.m_impulse;
        EXPECT_LE(std::hypot(J.x, J.y), 2 * J.z);
        EXPECT_LE(norm(scene.relativeVelocity(contact)), 1e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Directions, Sliding, testing::Values(0, 30, 45, 90, 135, 200, 300),
                         [](const auto& suite) { return std::to_string(suite.param); });

TEST(Friction, IsAbsentWithZeroCoefficient)
{
    ContactScene scene;
    scene.setVelocity({5, -3, -1});
    scene.touchLowerFace(0, 0);
    scene.solve();
    for (const ContactPoint& contact : scene.m_contacts)
        EXPECT_EQ(std::hypot(contact.m_impulse.x, contact.m_impulse.y), 0);
}

// --- The rotated scene has the rotated solution ---

class TurnedContact : public testing::TestWithParam<int>  // degrees about an oblique axis
{
};

TEST_P(TurnedContact, HasTheTurnedImpulses)
{
    const Mat3 Q = rotationAbout({1, -3, 2}, GetParam() * kPi / 180);
    ContactScene straight, turned(1e6, Q);
    for (ContactScene* scene : {&straight, &turned})
    {
        scene->setVelocity({0.7, -0.2, -1});
        scene->touchLowerFace(0, 0.4);
        scene->solve();
    }
    const double size = norm(straight.totalImpulse());
    for (int k = 0; k < 9; ++k)
        EXPECT_LE(norm(turned.m_contacts[k].m_impulse - Q * straight.m_contacts[k].m_impulse), 1e-5 * size) << k;
}

INSTANTIATE_TEST_SUITE_P(Turns, TurnedContact, testing::Values(30, 90, 137, 180),
                         [](const auto& suite) { return std::to_string(suite.param); });

}  // namespace
}  // namespace bullet_fem
