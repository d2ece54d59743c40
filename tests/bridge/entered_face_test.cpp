// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bridge/contact_finder_scene.h"

namespace bullet_fem
{
namespace
{

// Movable objects that have moved since the last search. The band is 3 cm wide.
class EnteredFaceTest : public ContactFinderScene
{
protected:
    EnteredFaceTest() { m_info.m_gravity.setZero(); }

    const std::vector<ContactPoint>& findAt(btRigidBody& body, double height)
    {
        body.getWorldTransform().setOrigin({btScalar(0.5), btScalar(0.5), btScalar(height)});
        body.setInterpolationWorldTransform(body.getWorldTransform());
        return find(body);
    }

    static constexpr double kHalf = 0.01;  // of the board's thickness [m]
    btBoxShape m_plank{btVector3(2, 2, btScalar(kHalf))};
    btRigidBody m_board{btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &m_plank, {1, 1, 1})};
    btSphereShape m_sphere{btScalar(0.2)};
    btRigidBody m_ball{btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &m_sphere, {1, 1, 1})};
};

}  // namespace

// The lower side of the board is the nearer one.
TEST_F(EnteredFaceTest, VerticesThatPassedABoardStayOnTheirSide)
{
    findAt(m_board, -0.015);
    for (const double height : {0.02, 0.025, 0.01})
    {
        const auto& contacts = findAt(m_board, height);
        ASSERT_GE(contacts.size(), 9u);
        for (const ContactPoint& c : contacts)
        {
            EXPECT_NEAR(c.m_normal.z, 1, 1e-6);
            EXPECT_NEAR(c.m_gap, -height - kHalf, 1e-6);
        }
    }
}

TEST_F(EnteredFaceTest, BoardThatAProgramPutsElsewhereHasNotPassed)
{
    findAt(m_board, -2);
    findAt(m_board, 0.02);
    for (const ContactOrigin& origin : m_fem.m_memory.m_origins)
        EXPECT_GE(origin.m_feature, m_fem.m_surface.topology().vertexCount()) << "of a vertex below the board";
}

// A ball that has turned by 100 degrees touches with another part of its surface.
TEST_F(EnteredFaceTest, RollingBallKeepsItsNormal)
{
    constexpr double kDepth = 0.05;
    const double height = 1 + 0.2 - kDepth;
    for (const double turn : {0., 1.75, 3.5})
    {
        m_ball.getWorldTransform().setRotation({{1, 0, 0}, btScalar(turn)});
        findAt(m_ball, height);
        EXPECT_NEAR(deepest()->m_gap, -kDepth, 1e-6);
        EXPECT_NEAR(deepest()->m_normal.z, -1, 1e-6);
    }
}

}  // namespace bullet_fem
