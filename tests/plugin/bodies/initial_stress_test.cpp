// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies with an initial stress, in Bullet's worlds.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/sleeping_world.h"
#include "plugin/scenes/snapshot_scene.h"

namespace bullet_fem
{
namespace
{

using InitialStresses = btAlignedObjectArray<btFemStress>;

constexpr double kUnsetYoung = 1e6, kUnsetPoisson = 0.3;  // [Pa], [-]

InitialStresses sameInAll(const btSoftBody& body, const btFemStress& stress)
{
    InitialStresses result;
    for (int e = 0; e < body.m_tetras.size(); ++e) result.push_back(stress);
    return result;
}

// -3 K alpha dT on the diagonal.
btFemStress heatStress(double strain)
{
    const auto s = static_cast<btScalar>(-strain * kUnsetYoung / (1 - 2 * kUnsetPoisson));
    return {s, s, s, 0, 0, 0};
}

double edgeOf(const btSoftBody& body)
{
    return (body.m_nodes[body.m_nodes.size() - 1].m_x - body.m_nodes[0].m_x).length() / std::sqrt(3.0);
}

class InitialStressOfABody : public SleepingScene, public testing::Test
{
protected:
    InitialStressOfABody() { addGround(); }
};

// 5 % in length by the formula; its weight, 400 N/m2, changes that by 4e-4.
TEST_F(InitialStressOfABody, WakesItAndMakesItGrow)
{
    btSoftBody& cube = addCube();
    sleepAll(cube);
    const double before = edgeOf(cube);
    m_fem.setInitialStress(&cube, sameInAll(cube, heatStress(0.05)));
    m_world.step(1);
    EXPECT_NE(cube.getActivationState(), ISLAND_SLEEPING);
    sleepAll(cube);
    EXPECT_NEAR(edgeOf(cube) / before, 1.05, 1e-3);
    // Setting equal stresses is no change, and the body stays asleep.
    m_fem.setInitialStress(&cube, sameInAll(cube, heatStress(0.05)));
    m_world.step(1);
    EXPECT_EQ(cube.getActivationState(), ISLAND_SLEEPING);
    m_fem.setInitialStress(&cube, {});
    m_world.step(1);
    EXPECT_NE(cube.getActivationState(), ISLAND_SLEEPING);
    sleepAll(cube);
    EXPECT_NEAR(edgeOf(cube) / before, 1, 1e-3);
}

// With all nodes held the body has the stress and does not move.
TEST_F(InitialStressOfABody, IsIncludedInTheReadStress)
{
    btSoftBody& cube = addCube(0, 3);
    for (int i = 0; i < cube.m_nodes.size(); ++i) cube.setMass(i, 0);
    m_world.step(1);
    const btFemStress given = {1000, -2000, 3000, 400, -500, 600};
    m_fem.setInitialStress(&cube, sameInAll(cube, given));
    m_world.step(10);
    InitialStresses read;
    ASSERT_TRUE(m_fem.getStress(&cube, read));
    for (int e = 0; e < read.size(); ++e)
    {
        EXPECT_NEAR(read[e].m_xx, given.m_xx, 1);
        EXPECT_NEAR(read[e].m_yy, given.m_yy, 1);
        EXPECT_NEAR(read[e].m_zz, given.m_zz, 1);
        EXPECT_NEAR(read[e].m_xy, given.m_xy, 1);
        EXPECT_NEAR(read[e].m_yz, given.m_yz, 1);
        EXPECT_NEAR(read[e].m_xz, given.m_xz, 1);
    }
}

// A body of twice the size has equal stresses, and so equal strains.
TEST_F(InitialStressOfABody, IsKeptWhenTheBodyIsScaledAndMoved)
{
    btSoftBody& cube = addCube();
    m_world.step(1);
    m_fem.setInitialStress(&cube, sameInAll(cube, heatStress(0.05)));
    cube.scale(btVector3(2, 2, 2));
    cube.translate(btVector3(0, 0, 1));
    m_world.step(200);
    EXPECT_NEAR(edgeOf(cube), 2 * 0.4 * 1.05, 2e-3);
}

TEST_F(InitialStressOfABody, BadOnesAreRefused)
{
    btSoftBody& cube = addCube();
    std::string why;
    EXPECT_FALSE(m_fem.setInitialStress(&cube, sameInAll(cube, {}), &why));
    EXPECT_NE(why.find("not moved by finite elements"), std::string::npos) << why;
    m_world.step(1);
    InitialStresses stress = sameInAll(cube, heatStress(0.05));
    stress[3].m_xy = std::numeric_limits<btScalar>::quiet_NaN();
    EXPECT_FALSE(m_fem.setInitialStress(&cube, stress, &why));
    EXPECT_NE(why.find("element 3"), std::string::npos) << why;
    stress.pop_back();
    EXPECT_FALSE(m_fem.setInitialStress(&cube, stress, &why));
    EXPECT_NE(why.find("give one each or none"), std::string::npos) << why;
    m_world.step(100);
    EXPECT_NEAR(edgeOf(cube), 0.4, 1e-3);
}

class InitialStressSnapshot : public testing::TestWithParam<Coupling>
{
};

TEST_P(InitialStressSnapshot, ContinuesBitForBit)
{
    SnapshotScene scene(GetParam());
    scene.addTower();
    btSoftBody& body = *scene.m_soft[0];
    scene.m_fem.prepare(&body, kStep);
    InitialStresses stress = sameInAll(body, heatStress(0.05));
    for (int e = 0; e < stress.size(); e += 3) stress[e].m_xy = 20000;
    scene.m_fem.setInitialStress(&body, stress);
    scene.m_world.step(40);
    ASSERT_GT(scene.contacts(), 10);
    const SnapshotScene::Saved saved = scene.saveAll();
    const std::vector<double> bits = scene.run(60);
    scene.m_fem.setInitialStress(&body, {});
    scene.restore(saved);
    EXPECT_TRUE(scene.run(60) == bits);
}
INSTANTIATE_TEST_SUITE_P(Couplings, InitialStressSnapshot, testing::Values(Coupling::swap, Coupling::coupled));

}  // namespace
}  // namespace bullet_fem
