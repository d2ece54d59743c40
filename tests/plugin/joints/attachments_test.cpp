// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Attachments between nodes of FEM bodies.
#include <gtest/gtest.h>

#include "plugin/scenes/anchor_scene.h"

namespace bullet_fem
{
namespace
{

class AttachmentsTest : public AnchorScene, public ::testing::Test
{
};

TEST_F(AttachmentsTest, TwoSoftBodiesHangTogetherByTheirNodes)
{
    btSoftBody &upper = addCube({0, 0, 0}), &lower = addCube({0, 0, btScalar(-2 * kHalf)});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    anchorAll(upper, nodesAt(upper, kHalf), ceiling);
    m_fem.prepare(&upper, kStep);
    m_fem.prepare(&lower, kStep);
    for (int i : nodesAt(upper, -kHalf))
        for (int j : nodesAt(lower, -kHalf))
            if (upper.m_nodes[i].m_x.distance(lower.m_nodes[j].m_x) < 1e-4) m_fem.attachNodes(&upper, i, &lower, j);
    m_world.step(400);
    EXPECT_LT(worstForce(60, upper, ceiling, {0, 0, 2 * kCubeWeight}), 1e-3);
    EXPECT_LT(worstForce(60, upper, lower, {0, 0, -kCubeWeight}), 1e-3);
    EXPECT_LT(worstForce(60, lower, upper, {0, 0, kCubeWeight}), 1e-3);
    EXPECT_LT(largestError(lower), 1e-5);
}

// The solver treats islands one after another; these two do not overlap, and one stands on the ground.
TEST(CoupledAttachmentsTest, BodiesOfDifferentIslandsInteract)
{
    struct Scene : AnchorScene
    {
        Scene() : AnchorScene(Coupling::coupled) {}
        Vec3 sumOfImpulses(btScalar order)
        {
            m_world.addPlane(btScalar(-kHalf));
            btSoftBody &a = addCube({-order, 0, 0}), &b = addCube({order, 0, 3});
            m_fem.prepare(&a, kStep);
            m_fem.prepare(&b, kStep);
            m_fem.attachNodes(&a, 0, &b, 0);
            m_world.step(3);
            EXPECT_EQ(m_fem.anchors(&a).size(), 1);
            EXPECT_EQ(m_fem.anchors(&b).size(), 1);
            EXPECT_GT(m_fem.anchors(&a)[0].m_impulse.length(), 1);
            return vec3(m_fem.anchors(&a)[0].m_impulse) + vec3(m_fem.anchors(&b)[0].m_impulse);
        }
    };
    EXPECT_EQ(norm(Scene().sumOfImpulses(1)), 0);
    EXPECT_EQ(norm(Scene().sumOfImpulses(-1)), 0);
}

TEST_F(AttachmentsTest, DetachedBodiesPart)
{
    btSoftBody &upper = addCube({0, 0, 0}), &lower = addCube({0, 0, btScalar(-2 * kHalf - 0.05)});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    anchorAll(upper, nodesAt(upper, kHalf), ceiling);
    m_fem.prepare(&upper, kStep);
    m_fem.prepare(&lower, kStep);
    const btScalar middle[4] = {btScalar(0.25), btScalar(0.25), btScalar(0.25), btScalar(0.25)};
    const int attachment = m_fem.attachNodeToTet(&lower, 0, &upper, 0, middle);
    m_world.step(10);
    EXPECT_EQ(m_fem.anchors(&lower).size(), 1);
    EXPECT_EQ(m_fem.anchors(&upper).size(), 10);
    m_fem.detach(&lower, attachment);
    m_world.step(10);
    EXPECT_EQ(m_fem.anchors(&lower).size(), 0);
}

// Although bodies that do not move keep their contacts.
TEST_F(AttachmentsTest, AttachedNodesLoseContactsOfRestingBodies)
{
    m_world.addPlane(btScalar(-kHalf));
    btSoftBody &lower = addCube({0, 0, 0}), &upper = addCube({0, 0, btScalar(2 * kHalf)});
    const int node = nodesAt(upper, kHalf).front();
    m_world.step(200);
    const auto contactsAtNode = [&]
    {
        int count = 0;
        for (int k = 0; k < m_fem.contacts(&upper).size(); ++k)
        {
            const btFemContact& contact = m_fem.contacts(&upper)[k];
            for (int a = 0; a < contact.m_nodeCount; ++a)
                count += contact.m_nodes[a] == node && contact.m_weights[a] > 0;
        }
        return count;
    };
    int opposite = 0;
    for (int j = 0; j < lower.m_nodes.size(); ++j)
        if (upper.m_nodes[node].m_x.distance(lower.m_nodes[j].m_x) <
            upper.m_nodes[node].m_x.distance(lower.m_nodes[opposite].m_x))
            opposite = j;
    EXPECT_GT(contactsAtNode(), 0);
    const int attachment = m_fem.attachNodes(&upper, node, &lower, opposite);
    m_world.step();
    EXPECT_EQ(contactsAtNode(), 0);
    m_world.step(60);
    EXPECT_EQ(contactsAtNode(), 0);
    m_fem.detach(&upper, attachment);
    m_world.step();
    EXPECT_GT(contactsAtNode(), 0);
}

TEST_F(AttachmentsTest, AnAttachmentEndsWithTheOtherBody)
{
    btSoftBody &a = addCube({0, 0, 0}), &b = addCube({2, 0, 0});
    m_fem.prepare(&a, kStep);
    m_fem.prepare(&b, kStep);
    m_fem.attachNodes(&a, 0, &b, 0);
    m_world.step(5);
    m_world.deleteSoft(b);
    m_world.step();
    EXPECT_NE(m_fem.stepReport(&a).m_flags & BT_FEM_LOST_ANCHOR, 0);
    m_world.step();
    EXPECT_EQ(m_fem.anchors(&a).size(), 0);
}

TEST_F(AttachmentsTest, BadAttachmentsAreRejected)
{
    btSoftBody &a = addCube({0, 0, 0}), &b = addCube({2, 0, 0});
    EXPECT_THROW(m_fem.attachNodes(&a, 0, &b, 0), std::invalid_argument);  // not FEM yet
    m_fem.prepare(&a, kStep);
    m_fem.prepare(&b, kStep);
    const btScalar weights[4] = {1, 1, 0, 0};
    EXPECT_THROW(m_fem.attachNodes(&a, -1, &b, 0), std::invalid_argument);
    EXPECT_THROW(m_fem.attachNodes(&a, 0, &b, 27), std::invalid_argument);
    EXPECT_THROW(m_fem.attachNodes(&a, 3, &a, 3), std::invalid_argument);
    EXPECT_THROW(m_fem.attachNodeToTet(&a, 0, &b, 0, weights), std::invalid_argument);
    EXPECT_THROW(m_fem.attachNodeToTet(&a, 0, &b, -1, weights), std::invalid_argument);
}

}  // namespace
}  // namespace bullet_fem
