// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/contact_scene.h"

// Obstacles supported by others: a soft cube meets a ball that lies on a floor, or on another ball.
namespace bullet_fem
{
namespace
{

constexpr double kRadius = 0.2, kLight = 10;  // of balls [m], [kg]; the cube has a ton

// Puts balls under the middle of the cube's lower face, one below another.
void putBalls(ContactScene& scene, int count)
{
    scene.setVelocity({0, 0, -2});
    scene.m_rigidProxies.resize(count);
    for (int k = 0; k < count; ++k)
    {
        RigidProxy& ball = scene.m_rigidProxies[k];
        makeBall(ball, kLight, kRadius);
        ball.m_center = Vec3{0.5, 0.5, -kRadius - 2 * kRadius * k};
    }
    scene.touchNode(4, 0, 0);
}

// The contact of a ball with the ball below; of the last ball with the floor.
RigidContact touchBelow(int ball, int count)
{
    RigidContact touch;
    touch.m_rigidProxy = ball;
    touch.m_other = ball + 1 < count ? ball + 1 : -1;
    touch.m_normal = {0, 0, 1};
    touch.m_arm = {0, 0, -kRadius};
    touch.m_otherArm = {0, 0, kRadius};
    return touch;
}

double impulseOf(ContactScene& scene)
{
    scene.solve();
    return scene.m_contacts[0].m_impulse.z;
}

double impulseOnTheFloor()
{
    ContactScene scene;
    scene.setVelocity({0, 0, -2});
    scene.touchNode(4, 0, 0);
    return impulseOf(scene);
}

}  // namespace

TEST(RigidContact, SupportsObjectsOnAFloor)
{
    const double whole = impulseOnTheFloor();
    for (int count : {1, 3})
    {
        ContactScene scene;
        putBalls(scene, count);
        for (int k = 0; k < count; ++k) scene.m_problem.m_rigidContacts.push_back(touchBelow(k, count));
        EXPECT_NEAR(impulseOf(scene), whole, 1e-3 * whole) << count;
        for (const RigidProxy& ball : scene.m_rigidProxies) EXPECT_NEAR(ball.m_linearVelocity.z, 0, 2e-3) << count;
    }
    ContactScene alone;
    putBalls(alone, 1);
    EXPECT_LT(impulseOf(alone), 0.5 * whole) << "without support";
}

TEST(RigidContact, NeverPulls)
{
    ContactScene scene;
    putBalls(scene, 1);
    scene.m_contacts.clear();
    scene.touchNode(4, 10, 0);  // far away
    scene.m_problem.m_rigidContacts.push_back(touchBelow(0, 1));
    scene.m_rigidProxies[0].m_linearVelocity = {0, 0, 1};
    scene.solve();
    EXPECT_EQ(scene.m_rigidProxies[0].m_linearVelocity.z, 1);
}

TEST(RigidContact, PreservesTheExistingGap)
{
    const double gap = 1e-3;
    ContactScene scene;
    putBalls(scene, 1);
    scene.m_problem.m_rigidContacts.push_back(touchBelow(0, 1));
    scene.m_problem.m_rigidContacts[0].m_leastSpeed = -gap / scene.m_settings.m_step.m_step;
    scene.solve();
    EXPECT_NEAR(scene.m_rigidProxies[0].m_linearVelocity.z, -gap / scene.m_settings.m_step.m_step, 2e-3);
}

// The soft cube moves by the whole correction if the ball cannot move, and by nearly none of it otherwise.
TEST(RigidContact, KeepsPositionCorrectionsOutOfTheFloor)
{
    for (const bool touches : {false, true})
    {
        ContactScene scene;
        putBalls(scene, 1);
        scene.setVelocity({});
        scene.m_contacts[0].m_gap = -0.05;
        RigidContact touch = touchBelow(0, 1);
        touch.m_pushOnly = true;
        if (touches) scene.m_problem.m_rigidContacts.push_back(touch);
        scene.solve();
        const double pushed = scene.m_rigidProxies[0].m_pushLinear.z;
        if (touches)
            EXPECT_NEAR(pushed, 0, 1e-3);
        else
            EXPECT_LT(pushed, -0.1);
    }
}

}  // namespace bullet_fem
