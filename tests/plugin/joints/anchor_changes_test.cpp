// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Anchors that are added, removed, or invalid.
#include <gtest/gtest.h>

#include "plugin/scenes/anchor_scene.h"
#include "plugin/scenes/each_world.h"

namespace bullet_fem
{
namespace
{

class AnchorChangesTest : public AnchorScene, public EachWorld
{
protected:
    AnchorChangesTest() : AnchorScene(Coupling::swap, {0, 0, btScalar(-kGravity)}, GetParam()) {}
};

INSTANTIATE_TEST_SUITE_P(Worlds, AnchorChangesTest, eachWorld(), nameOfWorld);

TEST_P(AnchorChangesTest, RemovedAnchorsLetGo)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    anchorAll(cube, nodesAt(cube, kHalf), ceiling);
    m_world.step(60);
    const int node = nodesAt(cube, kHalf)[0];
    cube.m_anchors.clear();
    const double height = centerOf(cube).z;
    m_world.step(30);
    EXPECT_NEAR(centerOf(cube).z - height, -0.5 * kGravity * 0.25, 0.1);
    EXPECT_EQ(m_fem.anchors(&cube).size(), 0);
    EXPECT_EQ(cube.m_nodes[node].m_battach, 0);
}

TEST_P(AnchorChangesTest, DeletedBodyLetsGoAndIsNotAccessed)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    anchorAll(cube, nodesAt(cube, kHalf), ceiling);
    m_world.step(30);
    m_world.deleteRigid(ceiling);
    m_world.step();
    EXPECT_NE(m_fem.stepReport(&cube).m_flags & BT_FEM_LOST_ANCHOR, 0);
    EXPECT_EQ(cube.m_anchors.size(), 0);
    m_world.step(30);
    EXPECT_EQ(m_fem.stepReport(&cube).m_flags & BT_FEM_LOST_ANCHOR, 0);
    EXPECT_LT(velocityOf(cube).z, -0.9 * kGravity * 30 * double(kStep));
}

TEST_P(AnchorChangesTest, AnAnchorToABodyOfAnotherWorldIsRemoved)
{
    btFemSoftBodySolver otherFem;
    SoftWorld other(otherFem);
    btRigidBody& foreign = other.addRigid(new btSphereShape(1));
    btSoftBody& cube = addCube({0, 0, 0});
    cube.appendAnchor(0, &foreign);
    m_world.step();
    EXPECT_NE(m_fem.stepReport(&cube).m_flags & BT_FEM_LOST_ANCHOR, 0);
    EXPECT_EQ(cube.m_anchors.size(), 0);
}

TEST_P(AnchorChangesTest, AForeignNodeIsFlagged)
{
    btSoftBody &cube = addCube({0, 0, 0}), &other = addCube({3, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    cube.appendAnchor(0, &ceiling);
    cube.m_anchors[0].m_node = &other.m_nodes[0];
    m_world.step();
    EXPECT_NE(m_fem.stepReport(&cube).m_flags & BT_FEM_BAD_ANCHOR, 0);
    EXPECT_EQ(m_fem.anchors(&cube).size(), 0);
}

}  // namespace
}  // namespace bullet_fem
