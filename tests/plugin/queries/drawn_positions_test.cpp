// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Interpolated positions of soft bodies between two steps agree with the motion states of Bullet's rigid bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr btScalar kFlight = 10;              // [m/s]
constexpr btScalar kSoftGap = btScalar(0.1);  // between the cubes [m]
const btScalar kFrames[] = {btScalar(1) / 144, btScalar(1) / 47, btScalar(1) / 75, btScalar(0.0031), btScalar(0.041)};

using DrawnArray = btAlignedObjectArray<btVector3>;

// A soft cube of 0.4 m that follows a rigid one along x; latency of interpolation as by default in Bullet's worlds.
class DrawnFlight : public EachWorldWith<bool>
{
protected:
    DrawnFlight() : m_world(worldClass(), btVector3(0, 0, 0))
    {
        m_world.bullet().setLatencyMotionStateInterpolation(value());
        RigidSettings rigid;
        rigid.m_mass = 64;
        rigid.m_transform = at(btScalar(0.4) + kSoftGap, 0, 0);
        rigid.m_velocity = {kFlight, 0, 0};
        m_rigid = &addRigidBox(m_world, {0.4, 0.4, 0.4}, rigid);
        m_soft = &addSmallCube(m_world, btScalar(-0.2));
        m_soft->addVelocity({kFlight, 0, 0});
    }

    double gapTo(const DrawnArray& drawn) const
    {
        btTransform shown;
        m_rigid->getMotionState()->getWorldTransform(shown);
        btScalar front = -1e9;
        for (int i = 0; i < drawn.size(); ++i) front = std::max(front, drawn[i].x());
        return double(shown.getOrigin().x() - btScalar(0.2) - front);
    }

    FemWorld m_world;
    btRigidBody* m_rigid;
    btSoftBody* m_soft;
};

TEST_P(DrawnFlight, SoftCubeKeepsItsDistanceFromARigidOne)
{
    DrawnArray drawn, stepped;
    double worst = 0, worstStepped = 0;
    for (int k = 0; k < 200; ++k)
    {
        m_world.bullet().stepSimulation(kFrames[k % 5], 4, kStep);
        const btScalar fraction = btFemHelpers::interpolationFraction(m_world.bullet());
        EXPECT_EQ(value(), fraction < 0);
        ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, fraction, drawn));
        ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, 0, stepped));
        worst = std::max(worst, std::fabs(gapTo(drawn) - double(kSoftGap)));
        worstStepped = std::max(worstStepped, std::fabs(gapTo(stepped) - double(kSoftGap)));
    }
    EXPECT_LT(worst, 1e-3);
    EXPECT_GT(worstStepped, 0.1);  // the error without interpolation
}

TEST_P(DrawnFlight, StepsOfNoFixedLengthAreDrawnWithTheRigidBodiesToo)
{
    DrawnArray drawn;
    for (int k = 0; k < 20; ++k)
    {
        m_world.bullet().stepSimulation(kFrames[k % 5], 0);
        ASSERT_TRUE(
            btFemHelpers::interpolateNodes(m_soft, btFemHelpers::interpolationFraction(m_world.bullet()), drawn));
        EXPECT_NEAR(gapTo(drawn), double(kSoftGap), 1e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(Worlds, DrawnFlight, testing::Combine(eachWorld(), testing::Bool()),
                         nameOfWorldWith([](bool latency) { return latency ? "latency" : "ahead"; }));

// A falling cube that draws a smaller one inside.
class DrawnFall : public testing::Test
{
protected:
    DrawnFall() : m_world(m_fem)
    {
        m_soft = &addUnitCube(m_world, {0, 0, 3});
        for (const btScalar x : {btScalar(-0.3), btScalar(0.3)})
            m_soft->m_renderNodes.push_back(renderNodeAt({x, x / 3, 3 - x}));
        btSoftBodyHelpers::interpolateBarycentricWeights(m_soft);
        m_world.step(6);
    }

    static btSoftBody::RenderNode renderNodeAt(const btVector3& position)
    {
        btSoftBody::RenderNode node;
        node.m_x = node.m_uv1 = position;
        return node;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody* m_soft;
    DrawnArray m_drawn;
};

void expectNodes(const btSoftBody& body, const DrawnArray& drawn, const btVector3 btSoftBody::Node::*where)
{
    ASSERT_EQ(body.m_nodes.size(), drawn.size());
    for (int i = 0; i < drawn.size(); ++i) EXPECT_EQ(0, drawn[i].distance(body.m_nodes[i].*where)) << i;
}

TEST_F(DrawnFall, FractionsLeadFromTheLastStepToTheNext)
{
    ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, 0, m_drawn));
    expectNodes(*m_soft, m_drawn, &btSoftBody::Node::m_x);
    ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, -1, m_drawn));
    for (int i = 0; i < m_drawn.size(); ++i)
        EXPECT_LT(m_drawn[i].distance(m_soft->m_nodes[i].m_q), 4e-7) << i;  // rounding of 3 m
    ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, btScalar(0.5), m_drawn));
    for (int i = 0; i < m_drawn.size(); ++i)
        EXPECT_LT(m_drawn[i].distance(m_soft->m_nodes[i].m_x + m_soft->m_nodes[i].m_v * (kStep / 2)), 4e-7) << i;
}

TEST_F(DrawnFall, FractionsOutOfRangeCountAsTheNearestBound)
{
    DrawnArray bound;
    for (const btScalar side : {btScalar(-1), btScalar(1)})
    {
        ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, side, bound));
        for (const btScalar far : {btScalar(1.5), std::numeric_limits<btScalar>::infinity()})
        {
            ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, side * far, m_drawn));
            for (int i = 0; i < m_drawn.size(); ++i) EXPECT_EQ(0, m_drawn[i].distance(bound[i])) << i;
        }
    }
    ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, std::numeric_limits<btScalar>::quiet_NaN(), m_drawn));
    expectNodes(*m_soft, m_drawn, &btSoftBody::Node::m_x);
}

TEST_F(DrawnFall, SleepingOrRemovedBodiesStandStill)
{
    m_soft->forceActivationState(ISLAND_SLEEPING);
    ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, btScalar(-0.5), m_drawn));
    expectNodes(*m_soft, m_drawn, &btSoftBody::Node::m_x);
    m_soft->forceActivationState(ACTIVE_TAG);
    m_world.take(*m_soft);
    ASSERT_TRUE(btFemHelpers::interpolateNodes(m_soft, btScalar(0.5), m_drawn));
    expectNodes(*m_soft, m_drawn, &btSoftBody::Node::m_x);
    m_world.put(*m_soft);
}

TEST_F(DrawnFall, NothingIsDrawnOfNoBody)
{
    m_drawn.resize(3);
    EXPECT_FALSE(btFemHelpers::interpolateNodes(nullptr, 0, m_drawn));
    EXPECT_EQ(0, m_drawn.size());
    m_drawn.resize(3);
    EXPECT_FALSE(btFemHelpers::interpolateEmbeddedSurface(nullptr, 0, m_drawn));
    EXPECT_EQ(0, m_drawn.size());
    m_drawn.resize(3);
    EXPECT_FALSE(btFemHelpers::interpolateEmbeddedSurface(&addUnitCube(m_world, {5, 0, 3}), 0, m_drawn));
    EXPECT_EQ(0, m_drawn.size());
}

TEST_F(DrawnFall, EmbeddedSurfaceFollowsTheDrawnNodes)
{
    ASSERT_TRUE(btFemHelpers::interpolateEmbeddedSurface(m_soft, 0, m_drawn));
    ASSERT_EQ(2, m_drawn.size());
    for (int v = 0; v < 2; ++v) EXPECT_LT(m_drawn[v].distance(m_soft->m_renderNodes[v].m_x), 1e-6);
    const double fallen = double(m_drawn[0].z());
    const double speed = double(m_soft->m_nodes[0].m_v.z());  // the cube falls as a rigid body
    ASSERT_TRUE(btFemHelpers::interpolateEmbeddedSurface(m_soft, btScalar(0.75), m_drawn));
    EXPECT_NEAR(fallen + 0.75 * double(kStep) * speed, double(m_drawn[0].z()), 1e-6);
    m_soft->m_renderNodesParents.clear();
    ASSERT_TRUE(btFemHelpers::interpolateEmbeddedSurface(m_soft, btScalar(0.75), m_drawn));
    for (int v = 0; v < 2; ++v) EXPECT_EQ(0, m_drawn[v].distance(m_soft->m_renderNodes[v].m_x));
}

}  // namespace
}  // namespace bullet_fem
