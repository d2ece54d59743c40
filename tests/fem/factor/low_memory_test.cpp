// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The low-memory path: its selection, its factor, and the agreement of its results with the full factor's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/factor/rest_factor.h"
#include "fem/scenes/contact_scene.h"
#include "fem/scenes/dense_system.h"
#include "fem/scenes/stepping_scenes.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

std::shared_ptr<const BodyModel> withChoice(const BodyModel& model, FactorChoice choice, std::size_t maxBytes = 0)
{
    FactorInput input = model.factorInput();
    input.m_choice = choice;
    input.m_maxBytes = maxBytes;
    return BodyModel::create(model.sharedShape(), input);
}

Body box(int cells)
{
    return makeBody(makeBox({1, 1, 1}, {cells, cells, cells}), dampedMaterial(),
                    [](const Vec3& X) { return X.x == 0; });
}

// --- Selection ---

class Choice : public testing::Test
{
protected:
    std::string refusal(FactorChoice choice, std::size_t maxBytes) const
    {
        try
        {
            withChoice(*m_full, choice, maxBytes);
        }
        catch (const std::runtime_error& error)
        {
            return error.what();
        }
        return "accepted";
    }

    const std::shared_ptr<const BodyModel> m_full = box(8).m_model;
    const std::size_t m_fullBytes = m_full->factorReport().m_bytes;
};

TEST_F(Choice, IsTheFullFactorUnlessSaidOtherwise)
{
    EXPECT_EQ(m_full->factorReport().m_path, FactorPath::full);
    EXPECT_EQ(m_full->factorReport().m_fullBytes, m_fullBytes);
    EXPECT_EQ(m_full->factor().lower().entry(), NodeEntry::block);
}

TEST_F(Choice, FallsBackOneByteBelowTheFullFactor)
{
    const auto fits = withChoice(*m_full, FactorChoice::lowMemoryBeyond, m_fullBytes);
    EXPECT_EQ(fits->factorReport().m_path, FactorPath::full);
    const auto low = withChoice(*m_full, FactorChoice::lowMemoryBeyond, m_fullBytes - 1);
    EXPECT_EQ(low->factorReport().m_path, FactorPath::lowMemory);
    EXPECT_EQ(low->factorReport().m_fullBytes, m_fullBytes);
    EXPECT_EQ(low->factorReport().m_bytes, low->factor().lower().byteCount());
    EXPECT_LE(low->factorReport().m_bytes, m_fullBytes / 6);  // a ninth, and panels padded to sixteen rows
}

TEST_F(Choice, LowMemoryNeedsNoLimit)
{
    EXPECT_EQ(withChoice(*m_full, FactorChoice::lowMemory)->factorReport().m_path, FactorPath::lowMemory);
    EXPECT_EQ(withChoice(*m_full, FactorChoice::lowMemoryBeyond)->factorReport().m_path, FactorPath::full);
}

// Each refusal names the required size and the remedy.
TEST_F(Choice, RejectsModelsBeyondTheLimitOnEitherPath)
{
    const std::size_t lowBytes = withChoice(*m_full, FactorChoice::lowMemory)->factorReport().m_bytes;
    EXPECT_THAT(refusal(FactorChoice::full, m_fullBytes - 1),
                testing::AllOf(testing::HasSubstr(std::to_string(m_fullBytes) + " bytes"),
                               testing::HasSubstr("low-memory path (" + std::to_string(lowBytes) + " bytes)")));
    for (const FactorChoice choice : {FactorChoice::lowMemory, FactorChoice::lowMemoryBeyond})
    {
        EXPECT_EQ(refusal(choice, lowBytes), "accepted");
        EXPECT_THAT(refusal(choice, lowBytes - 1),
                    testing::AllOf(testing::HasSubstr(std::to_string(lowBytes) + " bytes"),
                                   testing::HasSubstr("coarser"), testing::Not(testing::HasSubstr("low-memory"))));
    }
}

// --- The factor ---

// A third of the trace of each block of A0, from the textbook's A0, for each direction.
TEST(LowMemoryFactor, FactorsTheMeanOverDirections)
{
    const auto model = withChoice(*box(4).m_model, FactorChoice::lowMemory);
    const PackedFactor& lower = model->factor().lower();
    const int n = lower.size() / 3;
    const Eigen::MatrixXd A0 = denseRestSystem(model->shape(), model->factorInput());
    Eigen::MatrixXd mean(n, n);
    for (int i = 0; i < model->nodeCount(); ++i)
        for (int j = 0; j < model->nodeCount(); ++j)
            if (model->factor().position(i) >= 0 && model->factor().position(j) >= 0)
                mean(model->factor().position(i), model->factor().position(j)) =
                    A0.block<3, 3>(3 * i, 3 * j).trace() / 3;

    RandomVectors random(4);
    AlignedFloats y = allocateFloats(lower.vectorSize()), scratch = allocateFloats(lower.scratchSize());
    AlignedFloats lanes = allocateFloats(static_cast<std::size_t>(lower.size()) * kPanelLanes),
                  laneScratch = allocateFloats(lower.laneScratchSize());
    Eigen::MatrixXd right(n, 3), one(n, 3), ofSixteen(n, 3);
    const int lane = 11;
    std::fill(lanes.get(), lanes.get() + static_cast<std::size_t>(lower.size()) * kPanelLanes, 1.f);
    for (int i = 0; i < 3 * n; ++i)
    {
        y[i] = static_cast<float>(random.next().x);
        lanes[static_cast<std::size_t>(i) * kPanelLanes + lane] = y[i];
        right(i / 3, i % 3) = y[i];
    }
    lower.solve(y.get(), scratch.get());
    lower.solveLanes(lower.allSupernodes(), lower.allSupernodes(), lanes.get(), laneScratch.get());
    for (int i = 0; i < 3 * n; ++i)
    {
        one(i / 3, i % 3) = y[i];
        ofSixteen(i / 3, i % 3) = lanes[static_cast<std::size_t>(i) * kPanelLanes + lane];
    }
    const Eigen::MatrixXd expected = mean.llt().solve(right);
    const double single = 1e-5 * expected.norm();  // 6e-8 of single precision times a condition of some 100
    EXPECT_LE((one - expected).norm(), single);
    EXPECT_LE((ofSixteen - expected).norm(), single);
}

// --- Steps ---

Body bodyOf(std::shared_ptr<const BodyModel> model)
{
    Body body(std::move(model));
    setGravity(body, {0, 0, -9.81});
    return body;
}

// Both solve one system: the difference is the tolerance, a step, and single precision relative to the tip's
// displacement.
TEST(LowMemoryStep, MovesTheBeamAsTheFullFactorDoes)
{
    const Body beam =
        makeBody(makeBox({4, 1, 1}, {16, 4, 4}), dampedMaterial(1e6), [](const Vec3& X) { return X.x == 0; });
    Body full = bodyOf(beam.m_model), low = bodyOf(withChoice(*beam.m_model, FactorChoice::lowMemory));
    StepSettings settings;
    settings.m_tolerance = 1e-8;
    int fullIterations = 0, lowIterations = 0;
    for (int k = 0; k < 60; ++k)
    {
        const SolveReport a = step(full, settings), b = step(low, settings);
        EXPECT_EQ(a.m_stop, SolveStop::converged);
        EXPECT_EQ(b.m_stop, SolveStop::converged);
        fullIterations += a.m_iterations;
        lowIterations += b.m_iterations;
    }
    const int tip = nodeAt(beam.m_model->mesh(), {4, 0, 0});
    const double fallen = norm(full.m_state.m_x[tip] - beam.m_model->mesh().restPositions()[tip]);
    EXPECT_GT(fallen, 0.1);
    EXPECT_LE(largestDistance(full.m_state.m_x, low.m_state.m_x), 1e-7 * fallen);
    EXPECT_GT(lowIterations, fullIterations);
    EXPECT_LE(lowIterations, 10 * fullIterations);
}

TEST(LowMemoryStep, HasTheSameBitsForEveryNumberOfThreads)
{
    const auto model = withChoice(*box(12).m_model, FactorChoice::lowMemory);
    Body alone = bodyOf(model);
    for (int k = 0; k < 3; ++k) step(alone, StepSettings());
    for (const int count : {2, 3, 8})
    {
        const Threads threads(count);
        StepSettings settings;
        settings.m_threads = &threads;
        Body body = bodyOf(model);
        for (int k = 0; k < 3; ++k) step(body, settings);
        EXPECT_EQ(largestDistance(body.m_state.m_x, alone.m_state.m_x), 0) << count;
    }
}

TEST(LowMemoryStep, AllocatesNothing)
{
    Body body = bodyOf(withChoice(*box(4).m_model, FactorChoice::lowMemory));
    const AllocationCounter counter;
    for (int k = 0; k < 5; ++k) step(body, StepSettings());
    EXPECT_EQ(counter.count(), 0);
}

// A body with all nodes fixed has no factor.
TEST(LowMemoryStep, DoesNothingWithoutFreeNodes)
{
    const Body fixed = makeBody(makeBox({1, 1, 1}, {1, 1, 1}), Material(), [](const Vec3&) { return true; });
    Body body = bodyOf(withChoice(*fixed.m_model, FactorChoice::lowMemory));
    EXPECT_EQ(step(body, StepSettings()).m_stop, SolveStop::converged);
    EXPECT_EQ(largestDistance(body.m_state.m_x, fixed.m_model->mesh().restPositions()), 0);
}

// --- Contact ---

// Lets the cube come to rest on a frictionless plane (friction would make rest depend on the path); returns the nodes'
// impulses of the last step [N s].
std::vector<double> restImpulses(FactorChoice choice)
{
    ContactScene scene(1e5);
    scene.m_body.setModel(withChoice(*scene.m_body.m_model, choice));
    scene.m_cache = makeComplianceCache(scene.m_body.m_model);
    setGravity(scene.m_body, {0, 0, -9.81});
    for (int k = 0; k < 240; ++k)
    {
        scene.m_contacts.clear();
        for (int node = 0; node < 9; ++node) scene.touchNode(node, scene.m_body.m_state.m_x[node].z, 0);
        const ContactReport report = scene.solve();
        EXPECT_TRUE(report.m_converged) << k;
        finishStep(scene.m_body, scene.m_settings.m_step);
    }
    std::vector<double> impulses;
    for (const ContactPoint& contact : scene.m_contacts) impulses.push_back(contact.m_impulse.z);
    return impulses;
}

TEST(LowMemoryContact, RestsWithTheForcesOfTheFullFactor)
{
    const std::vector<double> full = restImpulses(FactorChoice::full), low = restImpulses(FactorChoice::lowMemory);
    double sum = 0;
    for (std::size_t k = 0; k < full.size(); ++k)
    {
        EXPECT_NEAR(low[k], full[k], 1e-3 * 9.81 * 1000 / 60 / 9) << k;
        sum += low[k];
    }
    EXPECT_NEAR(sum, 9.81 * 1000 / 60, 1e-3 * 9.81 * 1000 / 60);
}

// The correction is solved to 1e-3, and its impulse comes from columns with an error of 1e-3.
TEST(LowMemoryContact, TakesPenetrationBackByAShareWithoutVelocity)
{
    ContactScene scene;
    scene.m_body.setModel(withChoice(*scene.m_body.m_model, FactorChoice::lowMemory));
    scene.m_cache = makeComplianceCache(scene.m_body.m_model);
    scene.touchNode(4, -0.01, 0.5);
    scene.m_settings.m_pushFraction = 0.25;
    scene.solve();
    finishStep(scene.m_body, scene.m_settings.m_step);
    EXPECT_NEAR(scene.m_body.m_state.m_x[4].z, 0.0025, 3e-3 * 0.0025);
    for (const Vec3& v : scene.m_body.m_state.m_v) EXPECT_LE(norm(v), 1e-12);
}

TEST(LowMemoryContact, HasTheSameBitsForEveryNumberOfThreads)
{
    const auto model =
        withChoice(*makeBody(makeBox({1, 1, 1}, {12, 12, 12}), dampedMaterial()).m_model, FactorChoice::lowMemory);
    const auto place = [&](const Threads* threads)
    {
        ContactScene scene;
        scene.m_body = bodyOf(model);
        scene.m_cache = makeComplianceCache(model);
        scene.m_settings = {};
        scene.m_settings.m_step.m_threads = threads;
        for (int k = 0; k < 3; ++k)
        {
            scene.m_contacts.clear();
            for (int node = 0; node < 13; ++node) scene.touchNode(node, -1e-3, 0.5);
            scene.solve();
            finishStep(scene.m_body, scene.m_settings.m_step);
        }
        return scene.m_body.m_state.m_x;
    };
    const std::vector<Vec3> alone = place(nullptr);
    for (const int count : {2, 3})
    {
        const Threads threads(count);
        EXPECT_EQ(largestDistance(place(&threads), alone), 0) << count;
    }
}

}  // namespace
}  // namespace bullet_fem
