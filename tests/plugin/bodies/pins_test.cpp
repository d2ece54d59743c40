// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

/// A beam of 1 x .25 x .25 m along x, fixed at the nodes of its face x = 0, or free.
class Beam
{
public:
    Beam(WorldClass worldClass, bool pinned, const btVector3& gravity = {0, 0, btScalar(-kGravity)})
        : m_world(worldClass, implicitEuler(), gravity), m_fem(m_world.fem()), m_body(make())
    {
        for (int i = 0; i < m_body.m_nodes.size(); ++i)
            if (m_body.m_nodes[i].m_x.x() < btScalar(1e-6)) m_root.push_back(i);
        if (pinned)
            for (int i : m_root) m_body.setMass(i, 0);
        m_start = m_body.m_nodes[m_root[0]].m_x;
    }

    double tipHeight() const { return m_body.m_nodes[m_body.m_nodes.size() - 1].m_x.z(); }
    bool rootIsAt(const btVector3& offset) const
    {
        const btVector3 moved = m_body.m_nodes[m_root[0]].m_x - m_start;
        return (moved - offset).length() < btScalar(1e-6);
    }

    FemWorld m_world;
    btFemSoftBodySolver& m_fem;
    btSoftBody& m_body;
    std::vector<int> m_root;
    btVector3 m_start;

private:
    btSoftBody& make()
    {
        const btScalar half = btScalar(0.125);
        return m_world.addSoft(btFemHelpers::createBox(m_world.info(), btVector3(btScalar(0.5), 0, 0),
                                                       btVector3(btScalar(0.5), half, half), half));
    }
};

class Pins : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Pins, eachWorld(), nameOfWorld);

class NodeTarget : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, NodeTarget, eachWorld(), nameOfWorld);

TEST_P(Pins, HoldNodesOfInverseMassZeroToTheBit)
{
    Beam beam(GetParam(), true);
    std::vector<btVector3> before;
    for (int i : beam.m_root) before.push_back(beam.m_body.m_nodes[i].m_x);
    beam.m_world.step(60);
    for (std::size_t k = 0; k < before.size(); ++k)
    {
        EXPECT_EQ(beam.m_body.m_nodes[beam.m_root[k]].m_x, before[k]);
        EXPECT_EQ(beam.m_body.m_nodes[beam.m_root[k]].m_v, btVector3(0, 0, 0));
    }
    EXPECT_LT(beam.tipHeight(), 0.125 - 0.005);  // the free part sags
    EXPECT_EQ(beam.m_fem.stepReport(&beam.m_body).m_flags, 0);
}

TEST_P(Pins, ArePutInAndTakenOutAtAnyTimeAndTheRestShapeStays)
{
    Beam beam(GetParam(), false, btVector3(0, 0, 0));
    const std::vector<Vec3> rest = edgesOf(beam.m_body);
    beam.m_world.step(2);
    for (int i : beam.m_root) beam.m_body.m_nodes[i].m_im = 0;
    beam.m_world.setSoftGravity(btVector3(0, 0, btScalar(-kGravity)));
    beam.m_world.step(120);
    EXPECT_TRUE(beam.rootIsAt(btVector3(0, 0, 0)));
    EXPECT_GT(largestDifference(rest, edgesOf(beam.m_body)), 0.005);
    EXPECT_TRUE(beam.m_fem.stepReport(&beam.m_body).m_flags & BT_FEM_STALE_FACTOR);

    beam.m_world.setSoftGravity(btVector3(0, 0, 0));
    const btScalar inverse = beam.m_body.m_nodes[beam.m_body.m_nodes.size() / 2].m_im;
    for (int i : beam.m_root) beam.m_body.m_nodes[i].m_im = inverse;
    beam.m_world.step(300);
    for (std::size_t i = 0; i < rest.size(); ++i)  // lengths only, since the body may have rotated
        EXPECT_NEAR(norm(edgesOf(beam.m_body)[i]), norm(rest[i]), 1e-3);
}

TEST_P(Pins, GoWithinTheStepToThePositionWrittenToThem)
{
    Beam beam(GetParam(), true);
    beam.m_world.step(300);
    const double tip = beam.tipHeight();
    for (int k = 1; k <= 30; ++k)
    {
        for (int i : beam.m_root) beam.m_body.m_nodes[i].m_x += btVector3(0, 0, btScalar(0.01));
        beam.m_world.step();
        EXPECT_TRUE(beam.rootIsAt(btVector3(0, 0, btScalar(0.01) * k)));
        EXPECT_NEAR(beam.m_body.m_nodes[beam.m_root[0]].m_v.z(), 0.01 / kStep, 1e-3);
    }
    beam.m_world.step(1);
    EXPECT_TRUE(beam.rootIsAt(btVector3(0, 0, btScalar(0.3))));
    EXPECT_NEAR(beam.m_body.m_nodes[beam.m_root[0]].m_v.z(), 0, 1e-6);
    beam.m_world.step(300);
    EXPECT_NEAR(beam.tipHeight() - tip, 0.3, 0.01 * 0.3);  // the free part followed
}

TEST_P(Pins, MoveWithTheVelocityWrittenToThem)
{
    Beam beam(GetParam(), true);
    beam.m_world.step(5);
    for (int i : beam.m_root) beam.m_body.m_nodes[i].m_v = btVector3(0, btScalar(0.6), 0);
    beam.m_world.step(60);
    EXPECT_NEAR(beam.m_body.m_nodes[beam.m_root[0]].m_x.y() - beam.m_start.y(), 0.6, 1e-5);
}

TEST_P(NodeTarget, IsReachedWithinTheStepHeldAndLetGo)
{
    Beam beam(GetParam(), false, btVector3(0, 0, 0));
    beam.m_world.step(2);
    const int node = beam.m_root[0];
    const btScalar inverse = beam.m_body.m_nodes[node].m_im;
    const btVector3 target = beam.m_start + btVector3(0, 0, btScalar(0.02));
    beam.m_fem.setNodeTarget(&beam.m_body, node, target);
    for (int k = 0; k < 10; ++k)
    {
        beam.m_world.step();
        EXPECT_LT((beam.m_body.m_nodes[node].m_x - target).length(), 1e-6);
    }
    EXPECT_EQ(beam.m_body.m_nodes[node].m_im, inverse);  // its mass is kept
    beam.m_fem.clearNodeTarget(&beam.m_body, node);
    beam.m_body.setVelocity(btVector3(1, 0, 0));
    beam.m_world.step(30);
    EXPECT_NEAR(beam.m_body.m_nodes[node].m_x.x() - target.x(), 30 * kStep, 0.05);
    EXPECT_NEAR(velocityOf(beam.m_body).x, 1, 1e-3);
}

TEST_P(NodeTarget, PullsTheWholeBodyAlong)
{
    Beam beam(GetParam(), false, btVector3(0, 0, 0));
    beam.m_world.step(1);
    for (int k = 1; k <= 240; ++k)
    {
        for (int i : beam.m_root)
        {
            const btVector3& x = beam.m_body.m_nodes[i].m_x;
            beam.m_fem.setNodeTarget(&beam.m_body, i, x + btVector3(0, 0, kStep * btScalar(0.5)));
        }
        beam.m_world.step();
    }
    EXPECT_NEAR(velocityOf(beam.m_body).z, 0.5, 0.05);
    EXPECT_NEAR(centerOf(beam.m_body).z, 2, 0.05);
}

}  // namespace
}  // namespace bullet_fem
