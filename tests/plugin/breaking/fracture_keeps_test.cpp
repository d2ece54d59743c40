// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Properties that a body keeps when it splits.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "plugin/breaking/fracture_scene.h"

namespace bullet_fem
{
namespace
{

constexpr double kBearsHere = 8000;           // [Pa]
constexpr double kPullHere = kBearsHere / 4;  // with the section of .25 m2 [N]

std::vector<int> nodesAtRightEnd(const BarScene& scene)
{
    std::vector<int> end;
    for (int i = 0; i < scene.m_bar->m_nodes.size(); ++i)
        if (double(scene.m_bar->m_nodes[i].m_x.x()) > 0.999) end.push_back(i);
    return end;
}

// Beyond the yield stress the bar has plastic strains; each element keeps its own.
TEST(SplitBody, KeepsItsPlasticStrain)
{
    Bar bar;
    bar.m_isClampedLeft = true;
    BarScene scene(bar);
    btFemMaterial material;
    material.m_youngModulus = bar.m_youngModulus;
    material.m_poissonRatio = 0;
    material.m_massDamping = bar.m_massDamping;
    material.m_yieldStress = btScalar(0.6 * kBearsHere);
    material.m_hardeningModulus = bar.m_youngModulus / 2;
    scene.m_fem.setMaterial(scene.m_bar, material);
    scene.m_fem.prepare(scene.m_bar, kStep);
    scene.setStrength(kBearsHere);
    btAlignedObjectArray<btScalar> before, after;
    for (int k = 1; k <= 480 && scene.splits().size() == 0; ++k)
    {
        ASSERT_TRUE(scene.m_fem.getPlasticStrain(scene.m_bar, before) || k == 1);
        scene.pull(1.5 * kPullHere * k / 480);
        scene.m_world.step();
    }
    ASSERT_GT(scene.splits().size(), 0);
    ASSERT_TRUE(scene.m_fem.getPlasticStrain(scene.m_bar, after));
    ASSERT_EQ(after.size(), before.size());
    double sum = 0;
    for (int e = 0; e < after.size(); ++e)
    {
        EXPECT_GE(after[e], before[e]) << e;
        sum += double(before[e]);
    }
    EXPECT_GT(sum / after.size(), 1e-3);
}

int nearestNode(const btSoftBody& body, const btVector3& x)
{
    int nearest = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if ((body.m_nodes[i].m_x - x).length2() < (body.m_nodes[nearest].m_x - x).length2()) nearest = i;
    return nearest;
}

// The right end is attached to a wall .04 m away, which tears the bar in two, and to a spring. The attachments stay:
// the end is at the wall, and the report lists them.
TEST(SplitBody, KeepsAttachmentsAndSprings)
{
    Bar bar;
    bar.m_isClampedLeft = true;
    BarScene scene(bar);
    const TetMesh block = makeBox({0.2, 0.5, 0.5}, {1, 2, 2}, {1.04, -0.25, -0.25});
    btSoftBody* wall = btFemHelpers::createFromTetMesh(scene.m_world.info(), block);
    for (int i = 0; i < wall->m_nodes.size(); ++i) wall->setMass(i, 0);
    scene.m_world.addSoft(wall);
    scene.m_fem.prepare(wall, kStep);
    const std::vector<int> end = nodesAtRightEnd(scene);
    ASSERT_EQ(end.size(), 9u);
    std::vector<int> partner;
    for (const int i : end)
    {
        partner.push_back(nearestNode(*wall, scene.m_bar->m_nodes[i].m_x));
        scene.m_fem.attachNodes(scene.m_bar, i, wall, partner.back());
    }
    btFemSpring spring;
    spring.m_nodes[0] = end[4];
    spring.m_target = scene.m_bar->m_nodes[end[4]].m_x;
    scene.m_fem.addSpring(scene.m_bar, spring);
    scene.setStrength(kBearsHere);
    for (int k = 0; k < 120 && scene.parts() < 2; ++k) scene.m_world.step();
    ASSERT_GE(scene.parts(), 2);
    scene.m_world.step(60);
    for (std::size_t k = 0; k < end.size(); ++k)
        EXPECT_NEAR(double((scene.m_bar->m_nodes[end[k]].m_x - wall->m_nodes[partner[k]].m_x).length()), 0, 1e-3);
    EXPECT_EQ(scene.m_fem.anchors(scene.m_bar).size(), 10);
}

// Fibres belong to elements, which stay; a cable runs through nodes, which may have split.
TEST(SplitBody, KeepsFibresAndLosesCables)
{
    Bar bar;
    bar.m_isClampedLeft = true;
    BarScene scene(bar);
    btFemFibres fibres;
    fibres.m_directions.push_back(btVector3(0, 0, 1));
    fibres.m_activation = 500;
    const int muscle = scene.m_fem.addFibres(scene.m_bar, fibres);
    const std::vector<int> end = nodesAtRightEnd(scene);
    btFemCable cable;
    for (const int k : {0, 4}) cable.m_points.emplace_back(end[k]);
    cable.m_tension = 1;
    scene.m_fem.addCable(scene.m_bar, cable);
    scene.setStrength(kBearsHere);
    scene.pullInTwo(scene.pullUntilItSplits(2 * kPullHere));
    ASSERT_GE(scene.parts(), 2);
    btAlignedObjectArray<btFemActuatorReport> left;
    ASSERT_TRUE(scene.m_fem.getActuators(scene.m_bar, left));
    ASSERT_EQ(left.size(), 1);
    EXPECT_EQ(left[0].m_actuator, muscle);
    // Activated fibres of the fragments are in equilibrium: shorter by a / E, and without stress once detached.
    scene.m_world.step(120);
    btAlignedObjectArray<btScalar> activation;
    ASSERT_TRUE(scene.m_fem.getActivation(scene.m_bar, activation));
    for (int e = 0; e < activation.size(); ++e) EXPECT_EQ(activation[e], 500);
    double low = 1e30, high = -1e30;
    for (const int i : end)
    {
        low = std::min(low, double(scene.m_bar->m_nodes[i].m_x.z()));
        high = std::max(high, double(scene.m_bar->m_nodes[i].m_x.z()));
    }
    EXPECT_NEAR(high - low, 0.5 * (1 - 500 / 1e6), 2e-6);
    scene.m_fem.setActivation(scene.m_bar, muscle, 0);
    scene.m_world.step(120);
    btAlignedObjectArray<btScalar> stress;
    scene.m_fem.getVonMises(scene.m_bar, stress);
    for (int e = 0; e < stress.size(); ++e) EXPECT_LT(stress[e], 5) << e;
}

}  // namespace
}  // namespace bullet_fem
