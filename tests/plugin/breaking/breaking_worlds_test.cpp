// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Welded bodies in contact: breaking, momenta, and reproducible runs.
#include <gtest/gtest.h>

#include "plugin/breaking/welded_scene.h"
#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

CutBox plate()
{
    CutBox box;
    box.m_size = {1.2, 1.2, 0.15};
    box.m_cells = {8, 8, 1};
    box.m_slices = 0;
    box.m_voronoi = 9;
    box.m_youngModulus = btScalar(2e6);
    box.m_poissonRatio = btScalar(0.3);
    return box;
}

btFemWeldStrength brittle(double stress)
{
    btFemWeldStrength strength;
    strength.m_breakStress = btScalar(stress);
    return strength;
}

btRigidBody& addBall(SoftWorld& world, const btVector3& velocity)
{
    RigidSettings settings;
    settings.m_mass = 60;
    settings.m_transform = at(btScalar(0.05), btScalar(-0.03), btScalar(0.4));
    settings.m_velocity = velocity;
    return world.addRigid(new btSphereShape(btScalar(0.2)), settings);
}

class BrokenPlate : public testing::TestWithParam<Coupling>
{
};

INSTANTIATE_TEST_SUITE_P(Solvers, BrokenPlate, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

// In free space a ball flies through a plate of welded fragments.
TEST_P(BrokenPlate, ConservesMassAndMomentaWithTheProjectile)
{
    CutBoxScene scene(plate(), GetParam(), 0, {});
    ASSERT_GT(scene.weld(brittle(1e4)), 8);
    btRigidBody& ball = addBall(scene.m_world, {0, 0, -6});
    const auto total = [&]
    {
        Motion sum = scene.motion();
        sum += motionOf(ball);
        return sum;
    };
    const Motion before = total();
    double mass = 0, after = 0;
    for (const btFemPiece& piece : scene.m_pieces) mass += massOf(*piece.m_body);
    scene.m_world.step(40);
    int apart = 0;
    for (int k = 0; k < scene.breaks().size(); ++k) apart += scene.breaks()[k].m_left == 0;
    EXPECT_GT(apart, 2);
    for (const btFemPiece& piece : scene.m_pieces) after += massOf(*piece.m_body);
    EXPECT_EQ(after, mass);
    EXPECT_GT(total().m_linear.z - motionOf(ball).m_linear.z, -360);  // the plate was hit
    EXPECT_LT(motionOf(ball).m_linear.z, -20);                        // and the ball passed
    EXPECT_GT(motionOf(ball).m_linear.z, -350);
    const double scale = norm(before.m_linear);
    EXPECT_LT(norm(total().m_linear - before.m_linear), 5e-5 * scale);
    EXPECT_LT(norm(total().m_angular - before.m_angular), 5e-6 * scale);
    EXPECT_LT(total().m_energy, before.m_energy);
}

// Breaking itself changes no node state; only later steps do.
TEST_P(BrokenPlate, KeepsTheMotionOfTheWholeAtBreaking)
{
    const auto run = [](double stress)
    {
        CutBoxScene scene(plate(), GetParam(), 0, {});
        scene.weld(brittle(stress));
        addBall(scene.m_world, {0, 0, -6});
        std::vector<std::vector<btScalar>> bits;
        int firstBreak = -1;
        for (int k = 0; k < 20; ++k)
        {
            scene.m_world.step();
            if (firstBreak < 0 && scene.breaks().size() > 0) firstBreak = k;
            btFemWelds::clearBreaks(scene.m_fem);
            bits.push_back(scene.bits());
        }
        return std::make_pair(firstBreak, bits);
    };
    const auto strong = run(1e12), weak = run(4e4);
    ASSERT_LT(strong.first, 0);
    ASSERT_GE(weak.first, 0);
    for (int k = 0; k <= weak.first; ++k) EXPECT_TRUE(strong.second[k] == weak.second[k]) << k;
    EXPECT_FALSE(strong.second[weak.first + 1] == weak.second[weak.first + 1]);
}

// A ball falls through a plate that hangs between two walls; a strong plate stops it.
TEST_P(BrokenPlate, LetsTheBallThroughAndAStrongOneDoesNot)
{
    for (const double stress : {4e4, 1e12})
    {
        CutBox box = plate();
        box.m_slices = 4;
        CutBoxScene scene(box, GetParam(), kGravity, {});
        for (const btFemPiece& piece : scene.m_pieces)
            for (int i = 0; i < piece.m_body->m_nodes.size(); ++i)
                if (std::fabs(double(piece.m_body->m_nodes[i].m_x.x())) > 0.59) piece.m_body->setMass(i, 0);
        for (const btFemPiece& piece : scene.m_pieces) scene.m_fem.prepare(piece.m_body, kStep);
        scene.weld(brittle(stress));
        btRigidBody& ball = addBall(scene.m_world, {0, 0, -5});
        scene.m_world.step(90);
        for (const btFemPiece& piece : scene.m_pieces) EXPECT_TRUE(allFinite(*piece.m_body));
        if (stress < 1e6)
            EXPECT_LT(double(ball.getWorldTransform().getOrigin().z()), -0.5);
        else
            EXPECT_GT(double(ball.getWorldTransform().getOrigin().z()), -0.1);
    }
}

std::vector<btScalar> runPlate(Coupling coupling, int threads)
{
    btFemSolverInfo info;
    info.m_threads = threads;
    CutBoxScene scene(plate(), coupling, kGravity, info);
    scene.m_world.addPlane(-1);
    scene.weld(brittle(4e4));
    btRigidBody& ball = addBall(scene.m_world, {0, 0, -6});
    scene.m_world.step(60);
    EXPECT_GT(scene.breaks().size(), 4);
    std::vector<btScalar> bits = scene.bits();
    const std::vector<btScalar> more = bitsOf(ball);
    bits.insert(bits.end(), more.begin(), more.end());
    return bits;
}

TEST_P(BrokenPlate, HasTheSameBitsForEveryNumberOfThreads)
{
    const std::vector<btScalar> alone = runPlate(GetParam(), 1);
    for (const int threads : {2, 3, 8}) EXPECT_TRUE(runPlate(GetParam(), threads) == alone) << threads;
}

// Saved before it breaks, and while it is partly broken.
TEST_P(BrokenPlate, GoesOnToTheBitFromASavedState)
{
    CutBoxScene scene(plate(), GetParam(), kGravity, {});
    scene.m_world.addPlane(-1);
    scene.weld(brittle(4e4));
    btRigidBody& ball = addBall(scene.m_world, {0, 0, -6});
    bool broke = false;
    for (const int steps : {1, 5, 30})
    {
        scene.m_world.step(steps);
        const std::size_t welds = scene.welds().size();
        const BulletState bullet(scene.m_world);
        std::vector<unsigned char> saved;
        scene.m_fem.saveState(saved);
        bullet.restore(scene.m_world);
        std::vector<btScalar> first;
        for (int run = 0; run < 2; ++run)
        {
            btFemWelds::clearBreaks(scene.m_fem);
            scene.m_world.step(30);
            std::vector<btScalar> bits = scene.bits();
            const std::vector<btScalar> more = bitsOf(ball);
            bits.insert(bits.end(), more.begin(), more.end());
            bits.push_back(btScalar(scene.welds().size()));
            if (run == 0) first = bits;
            EXPECT_TRUE(bits == first) << steps;
            broke = broke || scene.breaks().size() > 0;
            bullet.restore(scene.m_world);
            scene.m_fem.restoreState(saved.data(), saved.size());
            EXPECT_EQ(scene.breaks().size(), 0);
            EXPECT_EQ(scene.welds().size(), welds);
            std::vector<unsigned char> again;
            scene.m_fem.saveState(again);
            EXPECT_TRUE(again == saved);
        }
    }
    EXPECT_TRUE(broke);
}

}  // namespace
}  // namespace bullet_fem
