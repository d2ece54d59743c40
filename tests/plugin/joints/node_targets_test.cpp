// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Groups of nodes with target poses.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

class NodeTargetsTest : public ::testing::Test
{
protected:
    NodeTargetsTest()
    {
        m_fem.prepare(&m_bar, kStep);
        for (int i = 0; i < m_bar.m_nodes.size(); ++i)
            if (m_bar.m_nodes[i].m_x.x() < btScalar(0.01)) m_group.push_back(i);
    }

    double farthest(const btTransform& fromRest) const
    {
        double largest = 0;
        for (int i : m_group) largest = std::max(largest, double(m_bar.m_nodes[i].m_x.distance(fromRest * m_rest[i])));
        return largest;
    }

    static std::vector<btVector3> positionsOf(const btSoftBody& body)
    {
        std::vector<btVector3> positions;
        for (int i = 0; i < body.m_nodes.size(); ++i) positions.push_back(body.m_nodes[i].m_x);
        return positions;
    }

    int count() const { return static_cast<int>(m_group.size()); }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem};
    btSoftBody& m_bar =
        m_world.addSoft(btFemHelpers::createBox(m_world.info(), btVector3(btScalar(0.5), 0, 0),
                                                btVector3(btScalar(0.5), btScalar(0.1), btScalar(0.1)), btScalar(0.1)));
    const std::vector<btVector3> m_rest = positionsOf(m_bar);
    std::vector<int> m_group;  // the end face x = 0
};

TEST_F(NodeTargetsTest, AGroupFollowsATransformOfItsRestShape)
{
    btTransform pose = btTransform::getIdentity();
    for (int k = 1; k <= 30; ++k)
    {
        pose.setOrigin(btVector3(0, 0, btScalar(0.01 * k)));
        pose.setRotation(btQuaternion(btVector3(0, 1, 0), btScalar(-0.02 * k)));
        m_fem.setNodeTargets(&m_bar, m_group.data(), count(), pose);
        m_world.step();
        ASSERT_LT(farthest(pose), 1e-6);
    }
    m_world.step(10);
    EXPECT_LT(farthest(pose), 1e-6);  // and stays there
}

TEST_F(NodeTargetsTest, AGroupFollowsPositions)
{
    std::vector<btVector3> positions;
    for (int i : m_group) positions.push_back(m_rest[i] * btScalar(1.05));
    m_fem.setNodeTargets(&m_bar, m_group.data(), count(), positions.data());
    m_world.step();
    for (int k = 0; k < count(); ++k) EXPECT_LT(m_bar.m_nodes[m_group[k]].m_x.distance(positions[k]), 1e-6);
}

TEST_F(NodeTargetsTest, ReleasedGroupFalls)
{
    m_fem.setNodeTargets(&m_bar, m_group.data(), count(), btTransform::getIdentity());
    m_world.step(5);
    m_fem.clearNodeTargets(&m_bar, m_group.data(), count());
    m_world.step(60);
    EXPECT_LT(velocityOf(m_bar).z, -0.95 * kGravity);
}

TEST_F(NodeTargetsTest, BadGroupIsRejectedBeforeAnyNodeIsChanged)
{
    const int outOfRange[2] = {m_group[0], m_bar.m_nodes.size()};
    std::vector<btVector3> positions(m_group.size(), btVector3(0, 0, 0));
    positions.back().setX(NAN);
    btTransform broken = btTransform::getIdentity();
    broken.setOrigin(btVector3(0, INFINITY, 0));
    EXPECT_THROW(m_fem.setNodeTargets(&m_bar, outOfRange, 2, btTransform::getIdentity()), std::invalid_argument);
    EXPECT_THROW(m_fem.setNodeTargets(&m_bar, m_group.data(), count(), positions.data()), std::invalid_argument);
    EXPECT_THROW(m_fem.setNodeTargets(&m_bar, m_group.data(), count(), broken), std::invalid_argument);
    const btVector3 faraway(0, 0, btScalar(-1.1e6));
    EXPECT_THROW(m_fem.setNodeTarget(&m_bar, m_group[0], faraway), std::invalid_argument);
    EXPECT_THROW(
        m_fem.setNodeTargets(&m_bar, m_group.data(), count(), btTransform(btQuaternion::getIdentity(), faraway)),
        std::invalid_argument);
    EXPECT_THROW(m_fem.setNodeTargets(&m_bar, nullptr, 2, btTransform::getIdentity()), std::invalid_argument);
    EXPECT_THROW(m_fem.setNodeTargets(&m_bar, m_group.data(), -1, positions.data()), std::invalid_argument);
    EXPECT_THROW(m_fem.clearNodeTargets(&m_bar, outOfRange, 2), std::invalid_argument);
    m_world.step(30);
    EXPECT_NEAR(velocityOf(m_bar).z, -kGravity * 30 * double(kStep), 1e-3);
}

// The factor does not include new pins: that costs iterations, but the body is not factored again at once.
TEST(NodeTargetsOfALargeBodyTest, PinningAtRunTimeCostsFewIterations)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    const btScalar half(0.25);
    btSoftBody& bar = world.addSoft(btFemHelpers::createBox(
        world.info(), btVector3(btScalar(0.9), 0, 0), btVector3(btScalar(0.9), half, half), half / btScalar(3.5)));
    fem.prepare(&bar, kStep);
    std::vector<int> group;
    for (int i = 0; i < bar.m_nodes.size(); ++i)
        if (bar.m_nodes[i].m_x.x() < btScalar(0.01)) group.push_back(i);
    ASSERT_EQ(group.size(), 64u);
    ASSERT_GT(bar.m_tetras.size(), 5000);
    world.step(30);
    const long entries = fem.stepReport(&bar).m_factorEntries;
    fem.setNodeTargets(&bar, group.data(), static_cast<int>(group.size()),
                       btTransform(btMatrix3x3::getIdentity(), btVector3(0, 0, btScalar(-0.5 * kGravity * 0.25))));
    int most = 0, all = 0;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        most = std::max(most, fem.stepReport(&bar).m_iterations);
        all += fem.stepReport(&bar).m_iterations;
    }
    EXPECT_LT(most, 40);
    EXPECT_LT(all, 60 * 25);
    EXPECT_EQ(fem.stepReport(&bar).m_factorEntries, entries);
    EXPECT_EQ(fem.stepReport(&bar).m_flags & BT_FEM_NOT_CONVERGED, 0);
}

}  // namespace
}  // namespace bullet_fem
