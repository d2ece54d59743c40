// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/fem/step/stepping.h"
#include "plugin/scenes/clamped_beam.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/setup/btFemFactorThread.h"

namespace bullet_fem
{
namespace
{

constexpr auto kPatience = std::chrono::minutes(2);  // timeout

std::shared_ptr<const RestShape> beamShape(int cells)
{
    return std::make_shared<const RestShape>(makeBox({4, 1, 1}, {4 * cells, cells, cells}), Material(),
                                             std::vector<double>());
}

FactorInput inputFor(const RestShape& shape, double mass = 1)
{
    FactorInput input;
    input.m_mass.assign(shape.m_mesh.nodeCount(), mass);
    input.m_fixed.assign(shape.m_mesh.nodeCount(), 0);
    return input;
}

void waitFor(const btFemFactorJob& job)
{
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!job.m_done && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    ASSERT_TRUE(job.m_done);
}

// Positions after a few steps of a model: they depend on each bit of its factor.
std::vector<Vec3> trajectory(const std::shared_ptr<const BodyModel>& model)
{
    Body body(model);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i) body.m_state.m_v[i] = {0, 0, double(i % 5)};
    StepSettings settings;
    for (int k = 0; k < 3; ++k) step(body, settings);
    return body.m_state.m_x;
}

TEST(FactorJobs, GiveTheModelOfASynchronousCall)
{
    btFemFactorThread worker;
    const auto shape = beamShape(3);
    const auto job = worker.start(shape, inputFor(*shape));
    EXPECT_EQ(worker.start(shape, inputFor(*shape)), job);
    EXPECT_NE(worker.start(shape, inputFor(*shape, 2)), job);
    waitFor(*job);
    ASSERT_TRUE(job->m_model);
    EXPECT_EQ(job->m_error, "");
    const auto a = trajectory(job->m_model), b = trajectory(BodyModel::create(shape, inputFor(*shape)));
    EXPECT_EQ(largestDifference(a, b), 0);
}

TEST(FactorJobs, ReportTheirFailures)
{
    btFemFactorThread worker;
    const auto shape = beamShape(2);
    FactorInput tooLarge = inputFor(*shape);
    tooLarge.m_maxBytes = 1000;
    const auto job = worker.start(shape, tooLarge);
    waitFor(*job);
    EXPECT_FALSE(job->m_model);
    EXPECT_NE(job->m_error.find("limit of 1000"), std::string::npos) << job->m_error;
}

TEST(FactorJobs, AreSkippedIfAbandoned)
{
    const auto shape = beamShape(4);
    std::weak_ptr<btFemFactorJob> dropped[50];
    std::shared_ptr<btFemFactorJob> last;
    {
        btFemFactorThread worker;
        for (int k = 0; k < 50; ++k) dropped[k] = worker.start(shape, inputFor(*shape, 1 + k));
        last = worker.start(shape, inputFor(*shape, 100));
        waitFor(*last);
        for (int k = 0; k < 50; ++k) worker.start(shape, inputFor(*shape, 200 + k));
    }  // destroyed with waiting jobs
    EXPECT_TRUE(last->m_model);
    for (const auto& job : dropped) EXPECT_TRUE(job.expired());
}

// The ordering of both uses the C library's only random generator.
TEST(FactorJobs, DoNotDisturbTheCallersOwnModels)
{
    const auto one = beamShape(4), other = beamShape(5);
    const auto oneAlone = trajectory(BodyModel::create(one, inputFor(*one)));
    const auto otherAlone = trajectory(BodyModel::create(other, inputFor(*other)));
    btFemFactorThread worker;
    for (int k = 0; k < 20; ++k)
    {
        const auto job = worker.start(one, inputFor(*one));
        const auto model = BodyModel::create(other, inputFor(*other));
        waitFor(*job);
        EXPECT_EQ(largestDifference(trajectory(model), otherAlone), 0) << k;
        EXPECT_EQ(largestDifference(trajectory(job->m_model), oneAlone), 0) << k;
    }
}

// --- In a world ---

btFemSolverInfo inBackground()
{
    btFemSolverInfo info = implicitEuler();
    info.m_refactoring = btFemRefactoring::background;
    info.m_tolerance = btScalar(1e-6);  // many iterations: a stale factor does not pay for long
    return info;
}

// Steps a quarter of the factor's until it is replaced, a millisecond apart; returns their number.
int exchanged(ClampedBeam& beam)
{
    const auto end = std::chrono::steady_clock::now() + kPatience;
    int steps = 0;
    while (!beam.isFlagged(BT_FEM_REFACTORED) && std::chrono::steady_clock::now() < end)
    {
        beam.step(1, kStep / 4);
        ++steps;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return steps;
}

TEST(BackgroundRefactoring, TakesTheNewFactorOverSomeTimeAfterItPays)
{
    ClampedBeam::Settings settings;
    settings.m_info = inBackground();
    ClampedBeam beam(settings);
    settings.m_info.m_refactoring = btFemRefactoring::onRequest;
    ClampedBeam asked(settings);
    beam.step(60);
    asked.step(60);
    const int steps = exchanged(beam);
    ASSERT_TRUE(beam.isFlagged(BT_FEM_REFACTORED));
    EXPECT_FALSE(beam.isFlagged(BT_FEM_STALE_FACTOR));
    asked.step(steps, kStep / 4);
    EXPECT_TRUE(asked.isFlagged(BT_FEM_REFACTOR_PAYS));
    EXPECT_LT(beam.report().m_iterations, asked.report().m_iterations);
    // Both solve to a relative 1e-6.
    EXPECT_LE((beam.tip() - asked.tip()).length(), 1e-4);
}

TEST(BackgroundRefactoring, SkipsFactorsNoLongerUseful)
{
    ClampedBeam::Settings settings;
    settings.m_info = inBackground();
    ClampedBeam beam(settings);
    beam.step(60);
    for (int k = 0; k < 1000 && !beam.isFlagged(BT_FEM_REFACTOR_PAYS); ++k) beam.step(1, kStep / 4);
    ASSERT_TRUE(beam.isFlagged(BT_FEM_REFACTOR_PAYS));
    beam.step(1, kStep / 4);  // requests a new factor
    for (int k = 0; k < 100; ++k)
    {
        beam.step();  // the old one fits again
        EXPECT_EQ(beam.report().m_flags, 0) << k;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

TEST(BackgroundRefactoring, ForgetsTheFactorOfAnotherMaterial)
{
    ClampedBeam::Settings settings;
    settings.m_info = inBackground();
    ClampedBeam beam(settings);
    beam.step(60);
    for (int k = 0; k < 1000 && !beam.isFlagged(BT_FEM_REFACTOR_PAYS); ++k) beam.step(1, kStep / 4);
    beam.step(1, kStep / 4);  // requests a new factor
    beam.fem().setMaterial(&beam.body(), btFemMaterial::foam());
    beam.step(1, kStep / 4);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    for (int k = 0; k < 3; ++k)
    {
        beam.step();
        EXPECT_EQ(beam.report().m_flags, BT_FEM_STALE_FACTOR) << k;
    }
}

// Bodies are added, removed, changed and refactored while their factors are computed; then the solver is destroyed.
TEST(BackgroundRefactoring, SurvivesAddedRemovedAndChangedBodies)
{
    std::mt19937 random(1);
    for (int round = 0; round < 4; ++round)
    {
        btFemSoftBodySolver fem(inBackground());
        SoftWorld world(fem);
        std::vector<btSoftBody*> bodies;
        const auto pick = [&] { return random() % bodies.size(); };
        int taken = 0, added = 0;
        for (int k = 0; k < 150; ++k)
        {
            while (bodies.size() < 5)
            {
                SoftBox box;
                box.m_cells = {2 + int(random() % 3), 3, 3};
                box.m_center = {3.0 * ++added, 0, 0};
                bodies.push_back(&addSoftBox(world, fem, box));
                clampBelow(*bodies.back(), -0.49);
            }
            world.step(1, kStep / btScalar(k % 40 < 20 ? 1 : 8));
            for (const btSoftBody* body : bodies)
            {
                taken += (fem.stepReport(body).m_flags & BT_FEM_REFACTORED) != 0;
                ASSERT_TRUE(allFinite(*body));
            }
            if (k % 7 == 0) fem.refactor(bodies[pick()]);
            if (k % 11 == 0) fem.setMaterial(bodies[pick()], btFemMaterial::foam());
            if (k % 5 == 0)
            {
                const std::size_t gone = pick();
                world.deleteSoft(*bodies[gone]);
                bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(gone));
            }
            if (k % 13 == 0) bodies[pick()]->m_nodes[0].m_im *= btScalar(0.01);
        }
        EXPECT_GT(taken, 0);
    }
}

}  // namespace
}  // namespace bullet_fem
