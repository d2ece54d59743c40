// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/soft_body_mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "bridge/bridge_test_bodies.h"

namespace bullet_fem
{
namespace
{

TEST(SoftBodyMesh, KeepsTheOrderOfNodesAndElements)
{
    const TestBox box({100, 0, 0});
    const TetMesh mesh = tetMeshOf(*box.m_body);
    ASSERT_EQ(mesh.nodeCount(), box.m_body->m_nodes.size());
    ASSERT_EQ(mesh.tetCount(), box.m_body->m_tetras.size());
    for (int i = 0; i < mesh.nodeCount(); ++i)
        EXPECT_NEAR(mesh.restPositions()[i].x, box.m_body->m_nodes[i].m_x.x() - box.m_body->m_nodes[0].m_x.x(), 1e-6);
    for (int a = 0; a < 4; ++a) EXPECT_EQ(mesh.tets()[5][a], box.m_body->m_tetras[5].m_n[a] - &box.m_body->m_nodes[0]);
}

TEST(SoftBodyMesh, BodiesWithoutStoredFractionsAreFull)
{
    EXPECT_TRUE(filledFractionsOf(*TestBox().m_body).empty());
}

TEST(SoftBodyMesh, FilledFractionsSurviveScalingAndNewMasses)
{
    const TestBox box;
    storeFill(*box.m_body, 0, 0.25, 1.5);
    box.m_body->scale(btVector3(2, 2, 2));
    box.m_body->setTotalMass(7);
    const std::vector<double> filled = filledFractionsOf(*box.m_body);
    ASSERT_EQ(filled.size(), static_cast<std::size_t>(box.m_body->m_tetras.size()));
    EXPECT_EQ(massScaleOf(*box.m_body), 1.5);
    EXPECT_EQ(filled[0], 0.25);
    EXPECT_EQ(filled[3], 1);
}

TEST(SoftBodyMesh, TheUnsetMaterialFollowsTheSpringStiffness)
{
    const TestBox box;
    box.m_body->m_materials[0]->m_kLST = btScalar(0.5);
    EXPECT_NEAR(unsetMaterialOf(*box.m_body).m_youngModulus, 5e5, 1);
    EXPECT_EQ(unsetMaterialOf(*box.m_body).m_density, 0);
    EXPECT_EQ(unsetMaterialOf(*box.m_body).m_bending, Bending::automatic);
    box.m_body->m_materials[0]->m_kLST = std::numeric_limits<btScalar>::quiet_NaN();
    EXPECT_TRUE(unsetMaterialOf(*box.m_body).valid());
}

TEST(SoftBodyMesh, MassesAddUpToDensityTimesFilledVolume)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {2, 2, 2});
    std::vector<double> filled(mesh.tetCount(), 1.0);
    filled[0] = 0.5;
    double total = 0;
    for (double m : lumpedMasses(mesh, filled, 300)) total += m;
    EXPECT_NEAR(total, 300 * (1 - 0.5 * mesh.tetVolume(0)), 1e-9);
}

TEST(SoftBodyMesh, UnusableMassesBecomeTheShareOfTheVolume)
{
    const TestBox box;
    const std::vector<double> share = lumpedMasses(tetMeshOf(*box.m_body), {}, 1);
    bool repaired = false;
    for (int i = 0; i < box.m_body->m_nodes.size(); ++i) box.m_body->m_nodes[i].m_im = btScalar(1 / (50 * share[i]));
    box.m_body->m_nodes[0].m_im = 0;  // pinned nodes need no repair
    sanitisedMasses(*box.m_body, share, repaired);
    EXPECT_FALSE(repaired);
    box.m_body->m_nodes[1].m_im = std::numeric_limits<btScalar>::infinity();
    const std::vector<double> mass = sanitisedMasses(*box.m_body, share, repaired);
    EXPECT_TRUE(repaired);
    EXPECT_NEAR(mass[0], 50 * share[0], 1e-6);
    EXPECT_NEAR(mass[1], 50 * share[1], 1e-6);
}

}  // namespace
}  // namespace bullet_fem
