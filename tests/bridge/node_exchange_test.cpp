// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/node_exchange.h"

#include <gtest/gtest.h>

#include <limits>

#include "bridge/bridge_test_bodies.h"

namespace bullet_fem
{
namespace
{

constexpr double kFrame = 1.0 / 60;

class NodeExchange : public ::testing::Test
{
protected:
    NodeExchange() { writeNodes(m_fem); }

    BodyState& state() { return m_fem.m_body.m_state; }
    btSoftBody::Node& node(int i) { return m_box.m_body->m_nodes[i]; }

    TestBox m_box;
    FemSoftBody m_fem = makeFemSoftBody(*m_box.m_body);
};

TEST_F(NodeExchange, LoadsOnlyComponentsWrittenByTheUser)
{
    state().m_x[3] = {1.00000000123, 2.00000000456, 3.00000000789};  // more digits than Bullet's float has
    writeNodes(m_fem);
    node(3).m_x.setY(5);
    readNodes(m_fem);
    EXPECT_EQ(state().m_x[3].x, 1.00000000123);
    EXPECT_EQ(state().m_x[3].y, 5);
    EXPECT_EQ(state().m_x[3].z, 3.00000000789);
}

TEST_F(NodeExchange, KeepsThePreviousPositionAndVelocityInBulletsFields)
{
    const btVector3 before = node(2).m_x;
    state().m_x[2] += Vec3{1, 0, 0};
    state().m_v[2] = {0, 7, 0};
    writeNodes(m_fem);
    EXPECT_EQ(node(2).m_q, before);
    EXPECT_EQ(node(2).m_vn, btVector3(0, 0, 0));
    EXPECT_EQ(node(2).m_v, btVector3(0, 7, 0));
}

TEST_F(NodeExchange, AMovedPinIsReachedWithinTheStepAndThenStands)
{
    node(0).m_im = 0;
    readNodes(m_fem);
    node(0).m_x += btVector3(btScalar(0.5), 0, 0);
    const Vec3 start = state().m_x[0];
    readNodes(m_fem);
    EXPECT_EQ(state().m_x[0].x, start.x) << "the pin must not jump";
    readLoads(m_fem, kFrame);
    EXPECT_NEAR(m_fem.m_body.m_loads.m_targetVelocity[0].x, 0.5 / kFrame, 1e-5);
    readLoads(m_fem, kFrame);
    EXPECT_EQ(m_fem.m_body.m_loads.m_targetVelocity[0].x, 0);
}

TEST_F(NodeExchange, ABodyMovedAsAWholeTakesItsPinsAlong)
{
    node(0).m_im = 0;
    readNodes(m_fem);
    for (int i = 0; i < m_box.m_body->m_nodes.size(); ++i) node(i).m_x += btVector3(0, 0, 4);
    const double before = state().m_x[0].z;
    readNodes(m_fem);
    EXPECT_NEAR(state().m_x[0].z, before + 4, 1e-6);
    readLoads(m_fem, kFrame);
    EXPECT_EQ(m_fem.m_body.m_loads.m_targetVelocity[0].z, 0);
}

TEST_F(NodeExchange, PinnedNodeKeepsAPrescribedVelocity)
{
    node(0).m_im = 0;
    node(0).m_v = btVector3(0, 2, 0);
    readNodes(m_fem);
    for (int step = 0; step < 3; ++step)
    {
        readLoads(m_fem, kFrame);
        EXPECT_EQ(m_fem.m_body.m_loads.m_targetVelocity[0].y, 2);
    }
}

TEST_F(NodeExchange, PinningAMovingNodeStopsIt)
{
    state().m_v[0] = {3, 0, 0};
    writeNodes(m_fem);
    node(0).m_im = 0;
    readNodes(m_fem);
    readLoads(m_fem, kFrame);
    EXPECT_EQ(m_fem.m_body.m_loads.m_targetVelocity[0].x, 0);
}

TEST_F(NodeExchange, RestoresNonFiniteValues)
{
    const btVector3 good = node(4).m_x;
    node(4).m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
    node(5).m_v.setZ(std::numeric_limits<btScalar>::infinity());
    EXPECT_TRUE(readNodes(m_fem).m_restored);
    EXPECT_EQ(node(4).m_x, good);
    EXPECT_EQ(node(5).m_v, btVector3(0, 0, 0));
    EXPECT_FALSE(readNodes(m_fem).m_restored);
}

TEST_F(NodeExchange, DropsNonFiniteForces)
{
    node(1).m_f = btVector3(std::numeric_limits<btScalar>::quiet_NaN(), 0, 0);
    node(2).m_f = btVector3(6, 0, 0);
    EXPECT_FALSE(readLoads(m_fem, kFrame));
    EXPECT_EQ(m_fem.m_body.m_loads.m_force[1].x, 0);
    EXPECT_EQ(m_fem.m_body.m_loads.m_force[2].x, 6);
    EXPECT_EQ(node(2).m_f, btVector3(0, 0, 0));
}

// A pressure of 1e30, for example.
TEST_F(NodeExchange, DropsForcesAboveTheLimit)
{
    double mass = 0;
    for (double m : m_fem.m_body.m_state.m_mass) mass += m;
    const double most = 1e6 * mass / kFrame;
    node(1).m_f = btVector3(btScalar(1.01 * most), 0, 0);
    node(2).m_f = btVector3(0, btScalar(-0.99 * most), 0);
    EXPECT_FALSE(readLoads(m_fem, kFrame));
    EXPECT_EQ(m_fem.m_body.m_loads.m_force[1].x, 0);
    EXPECT_NEAR(m_fem.m_body.m_loads.m_force[2].y, -0.99 * most, 1e-5 * most);
}

TEST_F(NodeExchange, TakesNewMassesAndKeepsTheOldOnesForBadOnes)
{
    const double old = state().m_mass[1];
    node(0).m_im = btScalar(0.25);
    node(1).m_im = -1;
    const NodeReadReport report = readNodes(m_fem);
    EXPECT_TRUE(report.m_badMass);
    EXPECT_EQ(state().m_mass[0], 4);
    EXPECT_EQ(state().m_mass[1], old);
}

TEST_F(NodeExchange, MeasuresHowFarTheFactorIsOff)
{
    EXPECT_NEAR(factorMismatch(m_fem, kFrame), 1, 1e-12);
    EXPECT_NEAR(factorMismatch(m_fem, kFrame / 4), 4, 1e-12);
    state().m_mass[7] *= 10;
    EXPECT_NEAR(factorMismatch(m_fem, kFrame), 10, 1e-12);
}

TEST_F(NodeExchange, ConvertsBulletsDampingToAnEquivalentRate)
{
    m_box.m_body->m_cfg.kDP = btScalar(0.5);
    readLoads(m_fem, kFrame);
    EXPECT_NEAR(1 / (1 + kFrame * m_fem.m_body.m_loads.m_massDamping), 0.5, 1e-12);
}

TEST_F(NodeExchange, BoundsHoldTheMotionToCome)
{
    for (Vec3& v : state().m_v) v = {60, 0, 0};
    setSweptBounds(m_fem, kFrame, 0.1);
    double highest = -1e9;
    for (const Vec3& x : state().m_x) highest = std::max(highest, x.x);
    EXPECT_NEAR(m_box.m_body->m_bounds[1].x(), highest + 1 + 0.1, 1e-5);
}

}  // namespace
}  // namespace bullet_fem
