// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/stepping.h"

#include <gtest/gtest.h>

#include "fem/scenes/stepping_scenes.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

bool atEnd(const Vec3& X)
{
    return X.x == 0;
}

StepSettings exactSettings(double tolerance = 1e-10)
{
    StepSettings settings;
    settings.m_tolerance = tolerance;
    return settings;
}

// --- Fixed nodes ---

TEST(FixedNodes, HoldUnderAnyLoad)
{
    Body body = clampedBeam();
    disturb(body);
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    for (int k = 0; k < 20; ++k) step(body, StepSettings());
    int held = 0;
    for (std::size_t i = 0; i < X.size(); ++i)
        held += body.m_state.m_fixed[i] && norm(body.m_state.m_x[i] - X[i]) == 0 && norm(body.m_state.m_v[i]) == 0;
    EXPECT_EQ(held, 9);
    EXPECT_GT(largestDistance(body.m_state.m_x, X), 0.01);
}

TEST(FixedNodes, FollowTheirTargetsToTheBit)
{
    Body body = clampedBeam();
    StepSettings settings;
    std::vector<Vec3> expected = body.m_state.m_x;
    for (int k = 0; k < 10; ++k)
    {
        for (std::size_t i = 0; i < expected.size(); ++i)
        {
            body.m_loads.m_targetVelocity[i] = {std::sin(0.3 * k), 0.2, 0.1 * static_cast<double>(i)};
            expected[i] += settings.m_step * body.m_loads.m_targetVelocity[i];
        }
        step(body, settings);
    }
    int followed = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        followed += body.m_state.m_fixed[i] && norm(body.m_state.m_x[i] - expected[i]) == 0;
    EXPECT_EQ(followed, 9);
}

// Fixed nodes with rigid motion move the body without strain: implicit Euler at constant velocity is exact.
TEST(FixedNodes, TakeTheBodyAlongInUniformMotion)
{
    Material material = dampedMaterial();
    material.m_massDamping = 0;
    Body body = makeBody(makeBox({1, 0.4, 0.4}, {5, 2, 2}), material, atEnd);
    const Vec3 v = {0.3, -1, 0.5};
    body.m_state.m_v.assign(body.m_state.m_v.size(), v);
    body.m_loads.m_targetVelocity.assign(body.m_state.m_v.size(), v);
    const StepSettings settings = exactSettings();
    for (int k = 0; k < 30; ++k) step(body, settings);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        EXPECT_LE(norm(body.m_state.m_x[i] - body.m_model->mesh().restPositions()[i] - 0.5 * v), 1e-12);
}

TEST(FixedNodes, MayBeAllThereIs)
{
    Body body = makeBody(makeBox({1, 1, 1}, {1, 1, 1}), Material(), [](const Vec3&) { return true; });
    body.m_loads.m_targetVelocity.assign(8, {1, 0, 0});
    const SolveReport report = step(body, StepSettings());
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_EQ(report.m_iterations, 0);
    EXPECT_EQ(report.m_residual, 0);
    EXPECT_EQ(body.m_state.m_v[7].x, 1);
}

// --- Closed-form motions ---

// v_n = v0 + n h g, x_n = x0 + n h v0 + g h^2 n (n + 1) / 2, for every node and any mesh.
TEST(FreeFall, IsImplicitEulersOwn)
{
    Material material = dampedMaterial();
    material.m_massDamping = 0;
    Body body = makeBody(makeSphere(0.5, 4), material);
    const Vec3 g = {0, -9.81, 0.5}, v0 = {1, 2, -3};
    setGravity(body, g);
    body.m_state.m_v.assign(body.m_state.m_v.size(), v0);
    const StepSettings settings = exactSettings();
    const double h = settings.m_step;
    for (int n = 1; n <= 60; ++n) step(body, settings);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
    {
        const Vec3 expected = body.m_model->mesh().restPositions()[i] + (60 * h) * v0 + (h * h * 60 * 61 / 2) * g;
        EXPECT_LE(norm(body.m_state.m_x[i] - expected), 1e-12 * norm(expected));
        EXPECT_LE(norm(body.m_state.m_v[i] - v0 - (60 * h) * g), 1e-12 * norm((60 * h) * g));
    }
}

// The rigid warm start is the solution: no iteration is needed.
TEST(FreeFall, TakesNoIteration)
{
    Body body = freeBlock();
    setGravity(body, {0, -9.81, 0});
    const SolveReport report = step(body, StepSettings());
    EXPECT_EQ(report.m_iterations, 0);
    EXPECT_EQ(report.m_stop, SolveStop::converged);
}

// v' = v / (1 + h alpha), where alpha is the sum of the material's and the loads'.
TEST(MassDamping, SlowsAFreeBody)
{
    Body body = freeBlock();
    body.m_state.m_v.assign(body.m_state.m_v.size(), {2, 0, 0});
    body.m_loads.m_massDamping = 0.6;
    for (int k = 0; k < 10; ++k) step(body, exactSettings());
    EXPECT_NEAR(body.m_state.m_v[5].x, 2 * std::pow(1 + 1.0 / 60, -10), 1e-12);
}

// The body moves by rounding of strains only.
TEST(Rest, IsNotDisturbed)
{
    Body body = clampedBeam();
    for (int k = 0; k < 100; ++k) EXPECT_EQ(step(body, StepSettings()).m_stop, SolveStop::converged) << k;
    EXPECT_LE(largestDistance(body.m_state.m_x, body.m_model->mesh().restPositions()), 1e-14);
    EXPECT_LE(largestDistance(body.m_state.m_v, std::vector<Vec3>(body.m_state.m_v.size())), 1e-14);
}

TEST(Momentum, FollowsTheLoadsToRounding)
{
    for (const double tolerance : {1e-1, 1e-3})
    {
        Material material = dampedMaterial();
        material.m_massDamping = 0;
        Body body = makeBody(makeBox({1, 0.6, 0.5}, {3, 2, 2}), material);
        disturb(body);
        StepSettings settings = exactSettings(tolerance);
        double size = 0;
        for (std::size_t i = 0; i < body.m_state.m_v.size(); ++i)
            size += body.m_state.m_mass[i] * norm(body.m_state.m_v[i]);
        for (int k = 0; k < 20; ++k)
        {
            Vec3 p = linearMomentum(body.m_state), L = angularMomentum(body.m_state);
            for (std::size_t i = 0; i < body.m_loads.m_force.size(); ++i)
            {
                p += settings.m_step * body.m_loads.m_force[i];
                L += settings.m_step * cross(body.m_state.m_x[i], body.m_loads.m_force[i]);
            }
            step(body, settings);
            EXPECT_LE(norm(linearMomentum(body.m_state) - p), 1e-13 * size) << k;
            EXPECT_LE(norm(angularMomentum(body.m_state) - L), 1e-13 * size) << k;  // x h v x m v = 0
        }
    }
}

TEST(Invariants, MatchHandValues)
{
    Body body =
        makeBody(TetMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}), elasticMaterial(260, 0.3, 24));
    body.m_state.m_v[1] = {0, 2, 0};  // every node has 1 kg
    EXPECT_LE(norm(linearMomentum(body.m_state) - Vec3{0, 2, 0}), 1e-15);
    EXPECT_LE(norm(angularMomentum(body.m_state) - Vec3{0, 0, 2}), 1e-15);
    EXPECT_DOUBLE_EQ(mechanicalEnergy(body), 2);
    // Stretched by 10 % along x: V (mu eps^2 + lambda / 2 eps^2) = (100 + 75) 0.01 / 6.
    body.m_state.m_x[1].x = 1.1;
    EXPECT_NEAR(mechanicalEnergy(body), 2 + 1.75 / 6, 1e-14);
    const Mat3 Q = rotationAbout({1, 2, 3}, 2);
    for (Vec3& x : body.m_state.m_x) x = Q * x + Vec3{5, 6, 7};
    EXPECT_NEAR(mechanicalEnergy(body), 2 + 1.75 / 6, 1e-13);
}

// --- Termination of the solve ---

TEST(DirectMode, TakesOneIteration)
{
    Body body = clampedBeam();
    disturb(body);
    StepSettings settings;
    settings.m_direct = true;
    settings.m_tolerance = 1e-9;
    const SolveReport report = step(body, settings);
    EXPECT_EQ(report.m_iterations, 1);
    EXPECT_EQ(report.m_stop, SolveStop::budget);
    EXPECT_LT(report.m_residual, 0.2);  // the iteration is accurate
}

TEST(Budget, IsReportedAndTheAnswerUsed)
{
    Body body = clampedBeam();
    disturb(body);
    StepSettings settings = exactSettings();
    settings.m_maxIterations = 2;
    const SolveReport report = step(body, settings);
    EXPECT_EQ(report.m_iterations, 2);
    EXPECT_EQ(report.m_stop, SolveStop::budget);
    EXPECT_GT(report.m_residual, 1e-10);
    EXPECT_LT(report.m_residual, 0.1);
}

TEST(Tolerance, TakesMoreIterationsTheTighterItIs)
{
    int last = 0;
    for (const double tolerance : {1e-2, 1e-5, 1e-8})
    {
        Body body = clampedBeam();
        disturb(body);
        const SolveReport report = step(body, exactSettings(tolerance));
        EXPECT_EQ(report.m_stop, SolveStop::converged);
        EXPECT_LE(report.m_residual, tolerance);
        EXPECT_GT(report.m_iterations, last);
        last = report.m_iterations;
    }
}

class GlobalWarp : public testing::TestWithParam<int>  // degrees
{
};

// A = Q A0 Q^T of a free body that is turned as a whole; single precision of the factor is far below 1e-3.
TEST_P(GlobalWarp, TakesOneIterationForARigidlyRotatedBody)
{
    Body body = freeBlock();
    const Mat3 Q = rotationAbout({3, -1, 2}, GetParam() * kPi / 180);
    for (Vec3& x : body.m_state.m_x) x = Q * x + Vec3{-4, 5, 6};
    RandomVectors random(8);
    for (Vec3& f : body.m_loads.m_force) f = random.next();
    StepSettings settings;
    settings.m_warp = Warp::global;
    const SolveReport report = step(body, settings);
    EXPECT_EQ(report.m_iterations, 1);
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_LE(report.m_residual, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Turns, GlobalWarp, testing::Values(0, 45, 90, 180),
                         [](const auto& suite) { return std::to_string(suite.param); });

TEST(Repeatability, TwoRunsGiveTheSameBits)
{
    const std::shared_ptr<const BodyModel> shared = freeBlock().m_model;
    std::vector<Vec3> last;
    for (int run = 0; run < 3; ++run)
    {
        Body body = run < 2 ? Body(shared) : freeBlock();  // a shared factor, and a new one
        disturb(body);
        for (int k = 0; k < 30; ++k) step(body, StepSettings());
        if (run == 0) last = body.m_state.m_x;
        EXPECT_EQ(largestDistance(body.m_state.m_x, last), 0) << run;
    }
}

// Extrapolating the increments of the last two steps saves iterations in smooth motion, and changes the solution within
// the tolerance.
TEST(WarmStart, LastTwoIncrementsSaveIterations)
{
    Body warm =
        makeBody(makeBox({4, 1, 1}, {8, 2, 2}), elasticMaterial(1e5, 0.3), [](const Vec3& X) { return X.x == 0; });
    Body cold(warm.m_model);
    for (Body* body : {&warm, &cold})
        for (std::size_t i = 0; i < body->m_state.m_x.size(); ++i)
            body->m_loads.m_force[i] = {0, 0, -9.81 * body->m_state.m_mass[i]};
    int warmIterations = 0, coldIterations = 0;
    for (int k = 0; k < 60; ++k)
    {
        for (std::vector<Vec3>& increment : cold.m_state.m_lastIncrement) increment.assign(increment.size(), Vec3());
        warmIterations += step(warm, StepSettings()).m_iterations;
        coldIterations += step(cold, StepSettings()).m_iterations;
    }
    EXPECT_LT(warmIterations, 0.7 * coldIterations);
    const double moved = largestDistance(cold.m_state.m_x, cold.m_model->mesh().restPositions());
    EXPECT_GT(moved, 0.5);
    EXPECT_LE(largestDistance(warm.m_state.m_x, cold.m_state.m_x), 2e-3 * moved);
}

// The stored increments are only an initial guess.
TEST(WarmStart, GuessOfAnotherMotionDoesNoHarm)
{
    Body body =
        makeBody(makeBox({1, 1, 1}, {3, 3, 3}), elasticMaterial(1e5, 0.3), [](const Vec3& X) { return X.z == 0; });
    Body other(body.m_model);
    RandomVectors random(5);
    for (std::vector<Vec3>& increment : other.m_state.m_lastIncrement)
        for (Vec3& dv : increment) dv = 1e3 * random.next();
    StepSettings settings;
    settings.m_tolerance = 1e-8;
    for (Body* b : {&body, &other})
    {
        b->m_loads.m_force[20] = {1, 2, 3};
        EXPECT_EQ(step(*b, settings).m_stop, SolveStop::converged);
    }
    const double moved = largestDistance(body.m_state.m_x, body.m_model->mesh().restPositions());
    EXPECT_GT(moved, 0);
    EXPECT_LE(largestDistance(body.m_state.m_x, other.m_state.m_x), 1e-6 * moved);
}

TEST(AbandonedStep, LeavesTheBodyInPlaceWithoutMotion)
{
    constexpr double kTooFast = 1e13;  // its square is finite in single precision
    Body body = makeBody(makeBox({1, 1, 1}, {1, 1, 1}), elasticMaterial(1e5, 0.3));
    const StepSettings settings;
    solveFreeMotion(body, settings);
    EXPECT_TRUE(canFinishStep(body));
    std::vector<Vec3> change(body.m_state.m_x.size());
    change[3].y = kTooFast;
    addVelocity(body, change);
    EXPECT_FALSE(canFinishStep(body));
    applyPositionCorrection(body, std::vector<Vec3>(change.size(), Vec3{0, 0, 1}), settings);
    const std::vector<Vec3> before = body.m_state.m_x;
    abandonStep(body);
    step(body, settings);  // no residue of the last step may be left
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LE(norm(body.m_state.m_x[i] - before[i]), 1e-12) << i;
}

}  // namespace
}  // namespace bullet_fem
