// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// FEM bodies and Bullet's cloth: collision filters, reports, determinism, and bodies that are added and removed.
#include <cstring>

#include "plugin/scenes/cloth_scene.h"

namespace bullet_fem
{
namespace
{

// A cloth over a pinned block, with the set of pairs in contact in this and in recent steps.
class ClothRules : public testing::TestWithParam<ClothWorldKind>
{
protected:
    static SoftBox blockBelow(double height)
    {
        SoftBox box;
        box.m_size = {0.6, 0.6, 0.4};
        box.m_cells = {3, 3, 2};
        box.m_center = {0, 0, height - 0.2};
        return box;
    }

    static void fill(ClothWorld& scene, btSoftBody*& block, btSoftBody*& cloth)
    {
        block = &scene.addBox(blockBelow(0));
        clampBelow(*block, -0.39);
        cloth = &scene.addPatch({0.01, 0.02, 0.1}, 0.8, 0.3, 11);
    }

    static bool falls(ClothWorld& scene, const btSoftBody& cloth)
    {
        scene.world().step(60);
        return lowestHeight(cloth) < -1;
    }
};

INSTANTIATE_TEST_SUITE_P(Worlds, ClothRules, eachClothWorld(), [](const auto& suite) { return nameOf(suite.param); });

// Without the deformable world, where Bullet's solver spreads NaN, and whose springs have more state than the nodes.
class ClothRulesOfSoftWorlds : public ClothRules
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, ClothRulesOfSoftWorlds, eachSoftClothWorld(),
                         [](const auto& suite) { return nameOf(suite.param); });

TEST_P(ClothRules, BothNeedTheSoftBodyFlag)
{
    for (const bool ofCloth : {false, true})
    {
        ClothWorld scene(GetParam());
        btSoftBody *block, *cloth;
        fill(scene, block, cloth);
        (ofCloth ? cloth : block)->m_cfg.collisions &= ~scene.softFlag();
        EXPECT_TRUE(falls(scene, *cloth)) << ofCloth;
        EXPECT_EQ(scene.fem().stepReport(block).m_contacts, 0);
    }
    ClothWorld scene(GetParam());
    btSoftBody *block, *cloth;
    fill(scene, block, cloth);
    EXPECT_FALSE(falls(scene, *cloth));
}

TEST_P(ClothRules, FiltersAndIgnoreListsAreObeyed)
{
    for (const int way : {0, 1, 2})
    {
        ClothWorld scene(GetParam());
        btSoftBody *block, *cloth;
        fill(scene, block, cloth);
        if (way == 0)
            cloth->setIgnoreCollisionCheck(block, true);
        else if (way == 1)
            block->m_collisionDisabledObjects.push_back(cloth);
        else
        {
            scene.world().take(*cloth);
            scene.world().put(*cloth, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::StaticFilter);
        }
        EXPECT_TRUE(falls(scene, *cloth)) << way;
    }
}

TEST_P(ClothRules, ContactIsReported)
{
    btFemSolverInfo info;
    info.m_manifolds = true;
    ClothWorld scene(GetParam(), {0, 0, btScalar(-kGravity)}, info);
    btSoftBody *block, *cloth;
    fill(scene, block, cloth);
    scene.world().step(120);
    const auto& contacts = scene.fem().contacts(block);
    ASSERT_GT(contacts.size(), 40);
    EXPECT_EQ(scene.fem().stepReport(block).m_contacts, contacts.size());
    for (int k = 0; k < contacts.size(); ++k)
    {
        EXPECT_EQ(contacts[k].m_other, cloth);
        EXPECT_LT(contacts[k].m_point.z(), 5e-3);  // on the block
    }
    ASSERT_EQ(scene.fem().touches(block).size(), 1);
    EXPECT_EQ(scene.fem().touches(block)[0].m_other, cloth);
    EXPECT_EQ(scene.fem().touches(block)[0].m_state, btFemTouchState::lasting);
    btDispatcher& dispatcher = *scene.world().bullet().getDispatcher();
    int shown = 0;
    for (int k = 0; k < dispatcher.getNumManifolds(); ++k)
        shown += dispatcher.getManifoldByIndexInternal(k)->getNumContacts();
    EXPECT_EQ(shown, MANIFOLD_CACHE_SIZE);
    cloth->translate(btVector3(0, 0, 5));
    scene.world().step();
    ASSERT_EQ(scene.fem().touches(block).size(), 1);
    EXPECT_EQ(scene.fem().touches(block)[0].m_state, btFemTouchState::ended);
}

// Bullet's islands wake bodies near moving cloth.
TEST_P(ClothRules, SleepingBodyIsWoken)
{
    ClothWorld scene(GetParam());
    btSoftBody& block = scene.addBox(blockBelow(0));
    clampBelow(block, -0.39);
    block.forceActivationState(ACTIVE_TAG);
    scene.world().step(400);
    ASSERT_EQ(block.getActivationState(), ISLAND_SLEEPING);
    btSoftBody& cloth = scene.addPatch({0.01, 0.02, 0.6}, 0.5, 0.3, 11);
    scene.world().step(90);
    EXPECT_GT(lowestHeight(cloth), 0);
    EXPECT_GT(scene.fem().stepReport(&block).m_contacts, 100);
}

TEST_P(ClothRules, BodiesInContactMayBeRemoved)
{
    for (const bool ofCloth : {false, true})
    {
        ClothWorld scene(GetParam());
        btSoftBody *block, *cloth;
        fill(scene, block, cloth);
        scene.world().step(60);
        ASSERT_GT(scene.fem().stepReport(block).m_contacts, 0);
        scene.world().deleteSoft(ofCloth ? *cloth : *block);
        scene.world().step(30);
        if (ofCloth)
            EXPECT_EQ(scene.fem().stepReport(block).m_contacts, 0);
        else
            EXPECT_LT(lowestHeight(*cloth), -0.3);
    }
}

// A program tears the cloth.
TEST_P(ClothRules, FacesInContactMayBeRemoved)
{
    ClothWorld scene(GetParam());
    btSoftBody *block, *cloth;
    fill(scene, block, cloth);
    scene.world().step(60);
    while (cloth->m_faces.size() > 0) cloth->m_faces.pop_back();
    cloth->m_fdbvt.clear();
    scene.world().step(5);
    EXPECT_GT(scene.fem().stepReport(block).m_contacts, 40);
    EXPECT_TRUE(allFinite(*cloth));
}

TEST_P(ClothRulesOfSoftWorlds, NonFiniteNodesHaveNoContact)
{
    ClothWorld scene(GetParam());
    btSoftBody *block, *cloth;
    fill(scene, block, cloth);
    scene.world().step(30);
    cloth->m_nodes[60].m_v.setX(std::numeric_limits<btScalar>::quiet_NaN());
    scene.world().step(5);
    EXPECT_TRUE(allFinite(*block));
}

TEST_P(ClothRules, TheDeepestContactsAreKept)
{
    btFemSolverInfo info;
    info.m_maxContacts = 20;
    ClothWorld scene(GetParam(), {0, 0, btScalar(-kGravity)}, info);
    btSoftBody *block, *cloth;
    fill(scene, block, cloth);
    scene.world().step(30);
    EXPECT_EQ(scene.fem().stepReport(block).m_contacts, 20);
    EXPECT_TRUE(scene.fem().stepReport(block).m_flags & BT_FEM_CONTACT_LIMIT);
}

TEST_P(ClothRules, HaveTheSameBitsForAnyNumberOfThreads)
{
    const auto run = [](int threads)
    {
        btFemSolverInfo info;
        info.m_threads = threads;
        ClothWorld scene(GetParam(), {0, 0, btScalar(-kGravity)}, info);
        btSoftBody *block, *cloth;
        fill(scene, block, cloth);
        std::vector<btSoftBody*> bodies = {block, cloth, &scene.addBall({0.1, 0, 0.4}, 0.2),
                                           &scene.addPatch({0, 0, 0.65}, 0.5, 0.2, 8),
                                           &scene.addRope({-0.4, 0.1, 0.7}, {0.4, 0.1, 0.7}, 0.1, 20)};
        std::vector<btScalar> bits;
        for (int k = 0; k < 40; ++k)
        {
            scene.world().step();
            for (const btSoftBody* body : bodies)
            {
                const std::vector<btScalar> now = bitsOf(*body);
                bits.insert(bits.end(), now.begin(), now.end());
            }
        }
        EXPECT_GT(scene.fem().stepReport(bodies[2]).m_contacts, 0);
        return bits;
    };
    const std::vector<btScalar> one = run(1);
    EXPECT_EQ(one, run(1));
    EXPECT_EQ(one, run(2));
    EXPECT_EQ(one, run(8));
}

// A saved state does not contain cloth: the program restores positions and velocities of its nodes.
TEST_P(ClothRulesOfSoftWorlds, SavedStateContinuesWithRestoredClothNodes)
{
    ClothWorld scene(GetParam());
    btSoftBody *block, *cloth;
    fill(scene, block, cloth);
    btSoftBody& ball = scene.addBall({0.1, 0, 0.4}, 0.2);
    scene.world().step(40);
    std::vector<unsigned char> state;
    ASSERT_TRUE(scene.fem().saveState(state));
    std::vector<btVector3> x, v;
    for (int i = 0; i < cloth->m_nodes.size(); ++i)
    {
        x.push_back(cloth->m_nodes[i].m_x);
        v.push_back(cloth->m_nodes[i].m_v);
    }
    const auto run = [&]
    {
        std::vector<btScalar> bits;
        for (int k = 0; k < 20; ++k)
        {
            scene.world().step();
            for (const btSoftBody* body : {static_cast<const btSoftBody*>(block), static_cast<const btSoftBody*>(cloth),
                                           static_cast<const btSoftBody*>(&ball)})
            {
                const std::vector<btScalar> now = bitsOf(*body);
                bits.insert(bits.end(), now.begin(), now.end());
            }
        }
        return bits;
    };
    const std::vector<btScalar> first = run();
    ASSERT_GT(scene.fem().stepReport(block).m_contacts, 0);
    ASSERT_TRUE(scene.fem().restoreState(state.data(), state.size()));
    for (int i = 0; i < cloth->m_nodes.size(); ++i)
    {
        cloth->m_nodes[i].m_x = x[i];
        cloth->m_nodes[i].m_v = v[i];
    }
    EXPECT_EQ(first, run());
}

}  // namespace
}  // namespace bullet_fem
