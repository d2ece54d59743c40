// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies split along element faces when the tension exceeds their strength.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "bullet_fem/fem/cage/cage.h"
#include "plugin/breaking/fracture_scene.h"
#include "plugin/scenes/each_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kStrength = 8000;               // [Pa]
constexpr double kSection = 0.25;                // of the bar [m2]
constexpr double kBears = kStrength * kSection;  // [N]

Bar heldBar()
{
    Bar bar;
    bar.m_isClampedLeft = true;
    return bar;
}

class SplittingBar : public testing::TestWithParam<Coupling>
{
};

INSTANTIATE_TEST_SUITE_P(Solvers, SplittingBar, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

// Stress is F / A: in a regular mesh, and in one without a plane of faces across the pull.
TEST_P(SplittingBar, BreaksAcrossThePullAtTheSetStrength)
{
    for (const BarMesh mesh : {BarMesh::regular, BarMesh::shaken})
    {
        Bar bar = heldBar();
        bar.m_mesh = mesh;
        BarScene scene(bar, GetParam());
        scene.setStrength(kStrength);
        const double force = scene.pullUntilItSplits(2 * kBears);
        ASSERT_EQ(scene.splits().size(), 1);
        EXPECT_NEAR(force / kSection, kStrength, 0.02 * kStrength);
        const btFemSplit& split = scene.splits()[0];
        EXPECT_GT(std::fabs(double(split.m_normal.x())), 0.99);
        EXPECT_GT(split.m_stress, btScalar(kStrength));
        scene.pullInTwo(force);
        EXPECT_EQ(scene.parts(), 2);
        double area = 0;
        for (int k = 0; k < scene.splits().size(); ++k) area += double(scene.splits()[k].m_area);
        EXPECT_NEAR(area, kSection, (mesh == BarMesh::regular ? 0.01 : 0.1) * kSection);  // and no other faces
    }
}

TEST_P(SplittingBar, StaysWholeJustBelowItsStrength)
{
    for (const BarMesh mesh : {BarMesh::regular, BarMesh::shaken})
    {
        Bar bar = heldBar();
        bar.m_mesh = mesh;
        BarScene scene(bar, GetParam());
        scene.setStrength(kStrength);
        const int nodes = scene.m_bar->m_nodes.size();
        scene.pullUntilItSplits(0.97 * kBears);
        scene.pullInTwo(0.97 * kBears);
        EXPECT_EQ(scene.splits().size(), 0);
        EXPECT_EQ(scene.m_bar->m_nodes.size(), nodes);
        scene.pullInTwo(1.02 * kBears);
        EXPECT_EQ(scene.parts(), 2);
    }
}

Bar notchedBar()
{
    Bar bar = heldBar();
    bar.m_cells = {16, 4, 4};
    bar.m_slit = 0.25;
    return bar;
}

// Half of the section is left at the slit, and the stress concentrates at its bottom.
TEST_P(SplittingBar, BreaksAtItsNotch)
{
    BarScene scene(notchedBar(), GetParam());
    scene.setStrength(kStrength);
    const double force = scene.pullUntilItSplits(kBears);
    ASSERT_GT(scene.splits().size(), 0);
    EXPECT_LT(force, 0.5 * kBears);
    EXPECT_GT(force, 0.05 * kBears);
    EXPECT_NEAR(double(scene.splits()[0].m_place.z()), 0, 0.02);
    scene.pullInTwo(force);
    EXPECT_EQ(scene.parts(), 2);
    for (int k = 0; k < scene.splits().size(); ++k)
        for (int node : scene.splits()[k].m_copyOf)
        {
            const Vec3 x = vec3(scene.m_bar->m_nodes[node].m_x);
            EXPECT_NEAR(x.x, 0.25, 0.05);
            EXPECT_LT(x.z, 0.02);
        }
}

/// A free bar in rotation while its ends are pulled.
Bar freeBar()
{
    Bar bar;
    bar.m_mesh = BarMesh::shaken;
    bar.m_poissonRatio = btScalar(0.3);
    bar.m_massDamping = 0;
    return bar;
}

void throwIt(const BarScene& scene)
{
    for (int i = 0; i < scene.m_bar->m_nodes.size(); ++i)
    {
        btSoftBody::Node& node = scene.m_bar->m_nodes[i];
        node.m_v = btVector3(btScalar(0.3), btScalar(-0.2), 1) +
                   btVector3(btScalar(0.1), btScalar(0.3), btScalar(0.2)).cross(node.m_x);
    }
}

// The reference bar has no strength, and an equal state when the other one splits.
TEST_P(SplittingBar, KeepsMassMotionAndStressAsItSplits)
{
    BarScene scene(freeBar(), GetParam(), 0, {}), twin(freeBar(), GetParam(), 0, {});
    scene.setStrength(kStrength);
    throwIt(scene);
    throwIt(twin);
    for (int k = 0; k < 300 && scene.splits().size() == 0; ++k)
        for (BarScene* bar : {&scene, &twin})
        {
            bar->pull(kBears * k / 100);
            bar->m_world.step();
        }
    ASSERT_EQ(scene.splits().size(), 1);
    const btFemSplit& split = scene.splits()[0];
    const btSoftBody &now = *scene.m_bar, &whole = *twin.m_bar;
    ASSERT_EQ(split.m_firstNode, whole.m_nodes.size());
    ASSERT_EQ(now.m_nodes.size(), split.m_firstNode + static_cast<int>(split.m_copyOf.size()));
    EXPECT_EQ(now.m_faces.size(), split.m_firstFace + 2 * split.m_faces);
    for (int i = 0; i < now.m_nodes.size(); ++i)
    {
        const int original = i < split.m_firstNode ? i : split.m_copyOf[i - split.m_firstNode];
        EXPECT_TRUE(now.m_nodes[i].m_x == whole.m_nodes[original].m_x) << i;
        EXPECT_TRUE(now.m_nodes[i].m_v == whole.m_nodes[original].m_v) << i;
    }
    EXPECT_NEAR(massOf(now), massOf(whole), 1e-5 * massOf(whole));
    const Motion before = motionOf(whole), after = motionOf(now);
    EXPECT_LT(norm(after.m_linear - before.m_linear), 1e-5 * norm(before.m_linear));
    EXPECT_LT(norm(after.m_angular - before.m_angular), 1e-5 * norm(before.m_angular));
    EXPECT_NEAR(after.m_energy, before.m_energy, 1e-5 * before.m_energy);
    btAlignedObjectArray<btFemStress> stress, wholeStress;
    EXPECT_TRUE(scene.m_fem.getStress(&now, stress));
    EXPECT_TRUE(twin.m_fem.getStress(&whole, wholeStress));
    for (int e = 0; e < stress.size(); ++e) EXPECT_NEAR(double(stress[e].m_xx), double(wholeStress[e].m_xx), 1);
}

TEST_P(SplittingBar, KeepsItsMomentaAfterwards)
{
    BarScene scene(freeBar(), GetParam(), 0, {});
    scene.setStrength(kStrength);
    throwIt(scene);
    scene.pullInTwo(2 * kBears);
    EXPECT_GT(scene.parts(), 1);
    const Motion before = motionOf(*scene.m_bar);
    scene.m_world.step(60);
    const Motion after = motionOf(*scene.m_bar);
    EXPECT_LT(norm(after.m_linear - before.m_linear), 5e-5 * norm(before.m_linear));
    EXPECT_LT(norm(after.m_angular - before.m_angular), 5e-5 * norm(before.m_angular));
}

// The halves move towards each other.
TEST_P(SplittingBar, PartsCollideUnlessDisabled)
{
    for (const bool touch : {true, false})
    {
        Bar bar;
        bar.m_massDamping = 0;
        BarScene scene(bar, GetParam());
        btFemTensileStrength strength;
        strength.m_tension = btScalar(kStrength);
        strength.m_partsTouch = touch;
        btFemFracture::setStrength(scene.m_fem, scene.m_bar, strength);
        scene.pullInTwo(1.5 * kBears);
        ASSERT_EQ(scene.parts(), 2);
        scene.m_world.step(20);
        EXPECT_GT(scene.gap(), 0);
        const std::vector<int> right = scene.isRight();
        btFemFracture::clearStrength(scene.m_fem, scene.m_bar);
        for (std::size_t i = 0; i < right.size(); ++i)
            scene.m_bar->m_nodes[int(i)].m_v = {btScalar(right[i] ? -1 : 1), 0, 0};
        const Vec3 before = motionOf(*scene.m_bar).m_linear;
        int touching = 0;
        for (int k = 0; k < 120; ++k)
        {
            scene.m_world.step();
            touching += scene.m_fem.contacts(scene.m_bar).size() > 0;
        }
        EXPECT_EQ(touching > 0, touch);
        EXPECT_EQ(scene.isRight() == right, touch);  // otherwise they have passed through each other
        EXPECT_LT(norm(motionOf(*scene.m_bar).m_linear - before), 1e-3 * massOf(*scene.m_bar));
    }
}

// The broken-off part falls on the remaining one and rests there; the contact force is its weight.
TEST_P(SplittingBar, SupportsTheBrokenOffPart)
{
    BarScene scene(heldBar(), GetParam());
    scene.setStrength(kStrength);
    scene.pullInTwo(1.1 * kBears);
    ASSERT_EQ(scene.parts(), 2);
    scene.m_world.setSoftGravity({btScalar(-kGravity), 0, 0});
    scene.m_world.step(240);
    EXPECT_EQ(scene.parts(), 2);
    EXPECT_NEAR(scene.gap(), 0, 0.01);
    EXPECT_LT(fastestNode(*scene.m_bar), 1e-3);
    const double weight = scene.rightMass() * kGravity;
    EXPECT_NEAR(std::fabs(impulseOn(scene.m_fem, *scene.m_bar, scene.m_bar).x) * 60, weight, 0.01 * weight);
}

// The nodes of its right end have targets and keep them.
TEST(Splitting, KeepsTargetsAndPins)
{
    BarScene scene(heldBar());
    scene.setStrength(kStrength);
    std::vector<int> end;
    for (int i = 0; i < scene.m_bar->m_nodes.size(); ++i)
        if (double(scene.m_bar->m_nodes[i].m_x.x()) > 0.999) end.push_back(i);
    for (int k = 1; k <= 90; ++k)
    {
        for (int i : end)
        {
            btVector3 x = scene.m_bar->m_nodes[i].m_x;
            x.setX(btScalar(1 + 0.03 * k / 60));
            scene.m_fem.setNodeTarget(scene.m_bar, i, x);
        }
        scene.m_world.step();
    }
    EXPECT_EQ(scene.parts(), 2);
    for (int i : end) EXPECT_NEAR(double(scene.m_bar->m_nodes[i].m_x.x()), 1.045, 1e-5);
    EXPECT_NEAR(double(scene.splits()[0].m_time), 8000e-6 * 2 / 0.03, 0.05);  // strain times length / speed
    scene.m_world.step(60);
    btAlignedObjectArray<btScalar> stress;
    scene.m_fem.getVonMises(scene.m_bar, stress);
    for (int e = 0; e < stress.size(); ++e) EXPECT_LT(double(stress[e]), 0.01 * kStrength);
    EXPECT_EQ(scene.splits().size(), 1);
}

TEST(Splitting, IsRejectedForBadInput)
{
    BarScene scene(heldBar());
    const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    std::string why;
    btFemTensileStrength strength;
    for (const double bad : {0.0, -1.0, nan, inf, 1e14})
    {
        strength.m_tension = btScalar(bad);
        EXPECT_FALSE(btFemFracture::setStrength(scene.m_fem, scene.m_bar, strength, &why));
        EXPECT_NE(why.find("m_tension"), std::string::npos) << why;
        EXPECT_NE(why.find("clearStrength"), std::string::npos) << why;
    }
    strength.m_tension = btScalar(kStrength);
    for (const int bad : {0, -1, 1001})
    {
        strength.m_mostCracks = bad;
        EXPECT_FALSE(btFemFracture::setStrength(scene.m_fem, scene.m_bar, strength, &why));
        EXPECT_NE(why.find("m_mostCracks"), std::string::npos) << why;
    }
    strength.m_mostCracks = 1;
    EXPECT_THROW(btFemFracture::setStrength(scene.m_fem, nullptr, strength), std::invalid_argument);
    btFemSoftBodySolver other;
    EXPECT_FALSE(btFemFracture::setStrength(other, scene.m_bar, strength, &why));
    EXPECT_NE(why.find("prepare()"), std::string::npos) << why;
    const TetMesh cube = makeBox({1, 1, 1}, {2, 2, 2}, {0, 0, 3});
    CageSettings cage;
    cage.m_cellSize = 0.3;
    btSoftBody* caged =
        btFemHelpers::createFromSurface(scene.m_world.info(), {cube.restPositions(), cube.surface()}, cage);
    scene.m_world.addSoft(caged);
    scene.m_fem.prepare(caged, kStep);
    EXPECT_FALSE(btFemFracture::setStrength(scene.m_fem, caged, strength, &why));
    EXPECT_NE(why.find("embedded surface"), std::string::npos) << why;
    EXPECT_TRUE(btFemFracture::setStrength(scene.m_fem, scene.m_bar, strength, &why)) << why;
    btFemFracture::clearStrength(scene.m_fem, scene.m_bar);
    btFemFracture::clearStrength(scene.m_fem, nullptr);
    scene.pullUntilItSplits(1.5 * kBears);
    EXPECT_EQ(scene.splits().size(), 0);
}

class SplittingInWorld : public EachWorld
{
};

TEST_P(SplittingInWorld, HappensAtTheSetStrength)
{
    BarScene scene(heldBar(), Coupling::swap, 0, implicitEuler(), GetParam());
    scene.setStrength(kStrength);
    const double force = scene.pullUntilItSplits(2 * kBears);
    EXPECT_NEAR(force, kBears, 0.02 * kBears);
    scene.pullInTwo(force);
    EXPECT_EQ(scene.parts(), 2);
    scene.m_world.step(30);
    EXPECT_TRUE(allFinite(*scene.m_bar));
}

INSTANTIATE_TEST_SUITE_P(Worlds, SplittingInWorld, eachWorld(), nameOfWorld);

}  // namespace
}  // namespace bullet_fem
