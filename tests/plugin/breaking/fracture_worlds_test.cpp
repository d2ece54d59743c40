// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Fracture in contact: momenta, reproducible runs, and saved states.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "plugin/breaking/fracture_scene.h"
#include "plugin/scenes/bullet_state.h"

namespace bullet_fem
{
namespace
{

constexpr double kBrittle = 5e4;  // [Pa]

Bar brittlePlate()
{
    Bar plate;
    plate.m_size = {1.2, 1.2, 0.15};
    plate.m_cells = {8, 8, 1};
    plate.m_youngModulus = btScalar(2e6);
    plate.m_poissonRatio = btScalar(0.3);
    plate.m_massDamping = 0;
    return plate;
}

btRigidBody& throwBall(SoftWorld& world)
{
    RigidSettings settings;
    settings.m_mass = 60;
    settings.m_transform = at(btScalar(0.05), btScalar(-0.03), btScalar(0.4));
    settings.m_velocity = {0, 0, -6};
    return world.addRigid(new btSphereShape(btScalar(0.2)), settings);
}

class SplittingPlate : public testing::TestWithParam<Coupling>
{
};

INSTANTIATE_TEST_SUITE_P(Solvers, SplittingPlate, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

// In free space a ball flies through the plate.
TEST_P(SplittingPlate, ConservesMassAndMomentaWithTheProjectile)
{
    BarScene scene(brittlePlate(), GetParam(), 0, {});
    scene.setStrength(kBrittle / 2.5, 20);
    btRigidBody& ball = throwBall(scene.m_world);
    const auto total = [&]
    {
        Motion sum = motionOf(*scene.m_bar);
        sum += motionOf(ball);
        return sum;
    };
    const Motion before = total();
    const double mass = massOf(*scene.m_bar);
    scene.m_world.step(40);
    EXPECT_GT(scene.parts(), 2);
    EXPECT_TRUE(allFinite(*scene.m_bar));
    EXPECT_NEAR(massOf(*scene.m_bar), mass, 1e-5 * mass);
    EXPECT_LT(norm(total().m_linear - before.m_linear), 5e-5 * norm(before.m_linear));
    EXPECT_LT(norm(total().m_angular - before.m_angular), 5e-5 * norm(before.m_linear));
    EXPECT_LT(total().m_energy, before.m_energy);
}

std::vector<btScalar> runSplittingPlate(Coupling coupling, int threads)
{
    btFemSolverInfo info;
    info.m_threads = threads;
    BarScene scene(brittlePlate(), coupling, kGravity, info);
    scene.m_world.addPlane(-1);
    scene.setStrength(kBrittle, 3);
    btRigidBody& ball = throwBall(scene.m_world);
    scene.m_world.step(30);
    EXPECT_GT(scene.splits().size(), 2);
    std::vector<btScalar> bits = scene.bits();
    const std::vector<btScalar> more = bitsOf(ball);
    bits.insert(bits.end(), more.begin(), more.end());
    return bits;
}

TEST_P(SplittingPlate, HasTheSameBitsForEveryNumberOfThreads)
{
    const std::vector<btScalar> alone = runSplittingPlate(GetParam(), 1);
    for (const int threads : {2, 3}) EXPECT_TRUE(runSplittingPlate(GetParam(), threads) == alone) << threads;
}

// A state from before a split is refused afterwards; one saved during fracture is restored as long as no further split
// happens.
TEST_P(SplittingPlate, GoesOnFromASavedStateAsLongAsItIsTheSameMesh)
{
    BarScene scene(brittlePlate(), GetParam(), kGravity, {});
    scene.m_world.addPlane(-1);
    scene.setStrength(kBrittle, 3);
    btRigidBody& ball = throwBall(scene.m_world);
    scene.m_world.step(1);
    std::vector<unsigned char> whole, saved;
    scene.m_fem.saveState(whole);
    scene.m_world.step(30);
    ASSERT_GT(scene.parts(), 1);
    const std::vector<btScalar> before = scene.bits();
    std::string why;
    EXPECT_FALSE(scene.m_fem.restoreState(whole.data(), whole.size(), &why));
    EXPECT_NE(why.find("has split since"), std::string::npos) << why;
    EXPECT_TRUE(scene.bits() == before);
    btFemFracture::clearStrength(scene.m_fem, scene.m_bar);
    const BulletState bullet(scene.m_world);
    scene.m_fem.saveState(saved);
    bullet.restore(scene.m_world);
    std::vector<btScalar> first;
    for (int run = 0; run < 2; ++run)
    {
        btFemFracture::clearSplits(scene.m_fem);
        scene.m_world.step(30);
        std::vector<btScalar> bits = scene.bits();
        const std::vector<btScalar> more = bitsOf(ball);
        bits.insert(bits.end(), more.begin(), more.end());
        if (run == 0) first = bits;
        EXPECT_TRUE(bits == first);
        bullet.restore(scene.m_world);
        EXPECT_TRUE(scene.m_fem.restoreState(saved.data(), saved.size(), &why)) << why;
        EXPECT_EQ(scene.splits().size(), 0);
        std::vector<unsigned char> again;
        scene.m_fem.saveState(again);
        EXPECT_TRUE(again == saved);
    }
}

// Fragments come to rest on the floor, and one upon another.
TEST_P(SplittingPlate, ComesToRestInParts)
{
    BarScene scene(brittlePlate(), GetParam(), kGravity);
    scene.m_world.addPlane(-1);
    scene.setStrength(kBrittle, 3);
    throwBall(scene.m_world);
    scene.m_world.step(240);
    EXPECT_GT(scene.parts(), 2);
    EXPECT_TRUE(allFinite(*scene.m_bar));
    EXPECT_GT(lowestHeight(*scene.m_bar), -1.02);
    EXPECT_LT(fastestNode(*scene.m_bar), 0.05);
    EXPECT_EQ(scene.m_fem.stepReport(scene.m_bar).m_flags & (BT_FEM_NOT_SPLIT | BT_FEM_RESTORED), 0);
}

}  // namespace
}  // namespace bullet_fem
