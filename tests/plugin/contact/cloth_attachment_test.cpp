// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Nodes of cloth attached to FEM bodies.
#include <stdexcept>
#include <string>

#include "plugin/scenes/cloth_scene.h"

namespace bullet_fem
{
namespace
{

// A cloth beside a pinned block, two of its corners attached to nodes of the block's upper rim.
class ClothAttachments : public testing::TestWithParam<ClothWorldKind>
{
protected:
    void build(ClothWorld& scene)
    {
        SoftBox box;
        box.m_size = {1, 0.5, 0.5};
        box.m_cells = {4, 2, 2};
        box.m_youngModulus = btScalar(1e7);
        m_block = &scene.addBox(box);
        for (int i = 0; i < m_block->m_nodes.size(); ++i)
            if (m_block->m_nodes[i].m_x.y() < btScalar(-0.24)) m_block->setMass(i, 0);
        m_cloth = &scene.addPatch({0, 0.75, 0.25}, 1, 0.4, 9);
        m_cloth->m_cfg.kDP = 0;
        m_cloth->m_cfg.collisions &= ~scene.softFlag();
        scene.fem().prepare(m_block, kStep);
        for (const int corner : {0, 8})
        {
            const int node = nearest(*m_block, vec3(m_cloth->m_nodes[corner].m_x));
            m_held.push_back({corner, node, scene.fem().attachNodes(m_cloth, corner, m_block, node)});
        }
    }

    static int nearest(const btSoftBody& body, const Vec3& to)
    {
        int found = 0;
        for (int i = 1; i < body.m_nodes.size(); ++i)
            if (norm(vec3(body.m_nodes[i].m_x) - to) < norm(vec3(body.m_nodes[found].m_x) - to)) found = i;
        return found;
    }

    struct Held
    {
        int m_corner, m_node, m_attachment;
    };
    btSoftBody *m_block = nullptr, *m_cloth = nullptr;
    std::vector<Held> m_held;
};

INSTANTIATE_TEST_SUITE_P(Worlds, ClothAttachments, eachClothWorld(),
                         [](const auto& suite) { return nameOf(suite.param); });

TEST_P(ClothAttachments, HoldAClothsWeight)
{
    ClothWorld scene(GetParam());
    build(scene);
    scene.world().step(240);
    double force = 0;
    const int frames = 240;
    for (int k = 0; k < frames; ++k)
    {
        scene.world().step();
        ASSERT_EQ(scene.fem().anchors(m_block).size(), 2);
        for (int j = 0; j < 2; ++j)
        {
            const btFemAnchorReport& report = scene.fem().anchors(m_block)[j];
            EXPECT_EQ(report.m_kind, btFemHold::attachment);
            EXPECT_EQ(report.m_object, m_cloth);
            force -= report.m_impulse.z() / double(kStep) / frames;
        }
        force -= scene.fem().contactForce(m_block, m_cloth).z() / frames;  // the cloth may be in contact with the block
        for (const Held& held : m_held)
            EXPECT_LT((m_cloth->m_nodes[held.m_corner].m_x - m_block->m_nodes[held.m_node].m_x).length(), 2e-3);
    }
    const double weight = massOf(*m_cloth) * kGravity;
    EXPECT_NEAR(force, weight, 0.05 * weight);  // it swings
}

TEST_P(ClothAttachments, KeepMomentum)
{
    ClothWorld scene(GetParam(), {0, 0, 0});
    btSoftBody& ball = scene.addBall({0, 0, 0}, 0.3, 10, 1e5);
    btSoftBody& cloth = scene.addPatch({0.9, 0, 0}, 1, 1, 6);
    cloth.m_cfg.kDP = 0;
    scene.fem().prepare(&ball, kStep);
    scene.fem().attachNodes(&cloth, 0, &ball, nearest(ball, {0.3, 0, 0}));
    scene.fem().attachNodes(&cloth, 30, &ball, nearest(ball, {0.3, 0, 0}));
    ball.setVelocity(btVector3(-1, 0, btScalar(0.5)));
    Motion before = motionOf(ball);
    before += motionOf(cloth);
    for (int k = 0; k < 60; ++k)
    {
        scene.world().step();
        Motion now = motionOf(ball);
        now += motionOf(cloth);
        EXPECT_LT(norm(now.m_linear - before.m_linear), 1e-5 * norm(before.m_linear));
    }
    EXPECT_LT(velocityOf(cloth).x, -0.2);
}

TEST_P(ClothAttachments, EndWithDetachOrTheCloth)
{
    for (const bool detach : {false, true})
    {
        ClothWorld scene(GetParam());
        m_held.clear();
        build(scene);
        scene.world().step(30);
        ASSERT_GT(lowestHeight(*m_cloth), -2);
        if (detach)
            for (const Held& held : m_held) scene.fem().detach(m_block, held.m_attachment);
        else
            scene.world().deleteSoft(*m_cloth);
        scene.world().step();
        EXPECT_EQ(scene.fem().anchors(m_block).size(), 0);
        EXPECT_EQ((scene.fem().stepReport(m_block).m_flags & BT_FEM_LOST_ANCHOR) != 0, !detach);
        scene.world().step(60);
        EXPECT_TRUE(!detach || lowestHeight(*m_cloth) < -3);
    }
}

// A saved state contains neither the cloth nor its attachments: both still exist, and the test restores the cloth's
// nodes.
TEST_P(ClothAttachments, StayWhenAStateIsRestored)
{
    ClothWorld scene(GetParam());
    build(scene);
    scene.world().step(30);
    std::vector<unsigned char> state;
    ASSERT_TRUE(scene.fem().saveState(state));
    std::vector<btVector3> x, v;
    for (int i = 0; i < m_cloth->m_nodes.size(); ++i)
    {
        x.push_back(m_cloth->m_nodes[i].m_x);
        v.push_back(m_cloth->m_nodes[i].m_v);
    }
    scene.world().step(10);
    const std::vector<btScalar> first = bitsOf(*m_block);
    const int later = scene.fem().attachNodes(m_cloth, 4, m_block, m_held[0].m_node);
    scene.fem().detach(m_block, later);
    const int held = scene.fem().attachNodes(m_cloth, 5, m_block, m_held[0].m_node);
    ASSERT_TRUE(scene.fem().restoreState(state.data(), state.size()));
    EXPECT_GT(scene.fem().attachNodes(m_cloth, 6, m_block, m_held[1].m_node), held);
    scene.fem().detach(m_block, held);
    scene.fem().detach(m_block, held + 1);
    for (int i = 0; i < m_cloth->m_nodes.size(); ++i)
    {
        m_cloth->m_nodes[i].m_x = x[i];
        m_cloth->m_nodes[i].m_v = v[i];
    }
    scene.world().step(10);
    EXPECT_EQ(scene.fem().anchors(m_block).size(), 2);
    // Springs of a deformable world have more state than the nodes.
    EXPECT_TRUE(GetParam() == ClothWorldKind::deformable || first == bitsOf(*m_block));
}

TEST_P(ClothAttachments, AreRefusedWithAReason)
{
    ClothWorld scene(GetParam());
    build(scene);
    std::string why;
    EXPECT_EQ(scene.fem().attachNodes(m_cloth, 81, m_block, 0, &why), 0);
    EXPECT_NE(why.find("node 81 is not in [0, 81) of the cloth"), std::string::npos) << why;
    EXPECT_EQ(scene.fem().attachNodes(m_cloth, 0, m_block, -1, &why), 0);
    EXPECT_NE(why.find("node -1"), std::string::npos) << why;
    const btScalar weights[4] = {1, 1, 0, 0};
    EXPECT_EQ(scene.fem().attachNodeToTet(m_cloth, 0, m_block, 0, weights, &why), 0);
    EXPECT_NE(why.find("sum 2"), std::string::npos) << why;
    EXPECT_THROW(scene.fem().attachNodes(m_block, 0, m_cloth, 0), std::invalid_argument);
}

}  // namespace
}  // namespace bullet_fem
