// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bridge/contact_finder_scene.h"

namespace bullet_fem
{
namespace
{

/// Objects that move far within a step: contacts lie where swept paths meet.
class ContactPathsTest : public ContactFinderScene
{
protected:
    ContactPathsTest()
    {
        m_info.m_gravity.setZero();
        m_ball.setCollisionShape(&m_sphere);
        m_ball.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    }
    /// Finds contacts with the ball at `start` at the beginning of the step; a kinematic object is queried at its moved
    /// pose.
    const std::vector<ContactPoint>& findFrom(const Vec3& start, const Vec3& velocity)
    {
        m_ball.getWorldTransform().setOrigin(bulletVector(start + kStep * velocity));
        m_ball.setInterpolationLinearVelocity(bulletVector(velocity));
        return find(m_ball);
    }

    btSphereShape m_sphere{btScalar(0.0625)};
    btCollisionObject m_ball;
};

}  // namespace

TEST_F(ContactPathsTest, BallHitsThePointInItsPath)
{
    // The path enters through the upper face and, unless stopped, leaves through the lower one.
    const auto& contacts = findFrom({0.3, 0.2, 1.5625}, {0, 0, -120});
    ASSERT_FALSE(contacts.empty());
    const auto first = deepest();
    EXPECT_NEAR(first->m_gap, 0.5, 1e-5);
    EXPECT_NEAR(first->m_normal.z, -1, 1e-6);
    EXPECT_NEAR(norm(first->m_point - Vec3{0.3, 0.2, 1}), 0, 1e-5);
    for (const ContactPoint& c : contacts) EXPECT_LT(std::hypot(c.m_point.x - 0.3, c.m_point.y - 0.2), 0.0626);
}

TEST_F(ContactPathsTest, ContactArmIsThatAtTheTimeOfImpact)
{
    const auto& contacts = findFrom({-0.2, 0.2, 1.5625}, {60, 0, -60});
    ASSERT_FALSE(contacts.empty());
    const Vec3 centre = m_rigidProxies.rigidProxies()[0].m_center;
    for (const ContactPoint& c : contacts)
        EXPECT_NEAR(norm(c.m_point + c.m_approach - centre - 0.0625 * c.m_normal), 0, 1e-5);
}

TEST_F(ContactPathsTest, ObjectsBesideThePathMakeNoContact)
{
    EXPECT_TRUE(findFrom({-1, 0.5, 1.07}, {200, 0, 0}).empty()) << "8 mm over the face";
    EXPECT_FALSE(findFrom({-1, 0.5, 1.06}, {200, 0, 0}).empty());
    EXPECT_TRUE(findFrom({0.5, 0.5, 1.07}, {0, 0, 100}).empty()) << "it leaves";
}

TEST_F(ContactPathsTest, InitialContactHasTheGapAtStepStart)
{
    ASSERT_FALSE(findFrom({0.3, 0.2, 1.05}, {0, 0, -120}).empty());
    const auto first = deepest();
    EXPECT_NEAR(first->m_gap, -0.0125, 1e-5);
    EXPECT_NEAR(norm(first->m_approach - Vec3{0, 0, -2}), 0, 1e-5) << "the object is 2 m farther on";
}

TEST_F(ContactPathsTest, GravityOfOneStepIsNotFastMotion)
{
    const double speed = 0.3 / kStep;  // more than half of the ball's diameter and of an edge in a step
    const auto fromTheBeginning = [&](const ContactPoint& c)  // the object has already moved to its end pose
    {
        return norm(c.m_approach - Vec3{0, 0, -speed * kStep}) < 1e-6;
    };
    m_info.m_gravity.setValue(0, 0, btScalar(-speed / kStep));
    const auto slow = findFrom({0.3, 0.2, 1.1}, {0, 0, -speed});
    EXPECT_FALSE(slow.empty());
    EXPECT_TRUE(std::all_of(slow.begin(), slow.end(), fromTheBeginning));
    m_info.m_gravity.setZero();
    const auto fast = findFrom({0.3, 0.2, 1.1}, {0, 0, -speed});
    EXPECT_FALSE(fast.empty());
    EXPECT_TRUE(std::none_of(fast.begin(), fast.end(), fromTheBeginning));
}

}  // namespace bullet_fem
