// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/scenes/dense_system.h"
#include "fem/scenes/stepping_scenes.h"

/// The parts of a step: free motion, impulses, position corrections.
namespace bullet_fem
{
namespace
{

TEST(Parts, VelocitiesAreTheStatesOnlyAfterTheStep)
{
    Body body = clampedBeam();
    disturb(body);
    const BodyState before = body.m_state;
    StepSettings settings;
    solveFreeMotion(body, settings);
    EXPECT_EQ(largestDistance(body.m_state.m_x, before.m_x), 0);
    EXPECT_EQ(largestDistance(body.m_state.m_v, before.m_v), 0);
    const std::vector<Vec3> v = velocity(body);
    EXPECT_GT(largestDistance(v, before.m_v), 0.01);
    finishStep(body, settings);
    EXPECT_EQ(largestDistance(body.m_state.m_v, v), 0);
    std::vector<Vec3> x = before.m_x;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += settings.m_step * v[i];
    EXPECT_LE(largestDistance(body.m_state.m_x, x), 1e-15);
}

TEST(Parts, ImpulsesOfZeroAndOnFixedNodesDoNothing)
{
    Body body = clampedBeam();
    disturb(body);
    solveFreeMotion(body, StepSettings());
    const std::vector<Vec3> before = velocity(body);
    std::vector<Vec3> impulses(before.size());
    for (std::size_t i = 0; i < before.size(); ++i)
        if (body.m_state.m_fixed[i]) impulses[i] = {1, 2, 3};
    const SolveReport report = applyImpulses(body, impulses, StepSettings());
    EXPECT_EQ(report.m_iterations, 0);
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    EXPECT_EQ(largestDistance(velocity(body), before), 0);
}

// An impulse too small to be solved for still changes the momentum.
TEST(Parts, ImpulsesTooSmallToBeSolvedForKeepMomentum)
{
    Body body = freeBlock();
    StepSettings settings;
    solveFreeMotion(body, settings);
    BodyState before = body.m_state, after = body.m_state;
    before.m_v = velocity(body);
    std::vector<Vec3> impulses(before.m_v.size());
    impulses.front() = {0.1, 0.2, -0.3};
    const SolveReport report = applyImpulses(body, impulses, settings, 1e6);
    EXPECT_EQ(report.m_iterations, 0);
    after.m_v = velocity(body);
    const double damped = 1 / (1 + settings.m_step * body.m_model->shape().m_material.m_massDamping);
    const Vec3 J = damped * impulses.front(), L = cross(before.m_x.front(), J);
    EXPECT_LE(norm(linearMomentum(after) - linearMomentum(before) - J), 1e-13 * norm(J));
    EXPECT_LE(norm(angularMomentum(after) - angularMomentum(before) - L), 1e-12 * (norm(L) + norm(J)));
}

// A position correction moves this step's positions by h P J, and changes no velocity.
TEST(Parts, PushesMoveWithoutVelocity)
{
    Body body = clampedBeam();
    StepSettings settings;
    solveFreeMotion(body, settings);
    std::vector<Vec3> impulses(body.m_state.m_x.size());
    impulses.back() = {0, 0, 0.1};
    applyPositionCorrection(body, impulses, settings);
    finishStep(body, settings);
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    const Eigen::MatrixXd A0 =
        constrained(denseRestSystem(body.m_model->shape(), body.m_model->factorInput()), body.m_state.m_fixed);
    const Eigen::VectorXd moved = flat(body.m_state.m_x) - flat(X);
    const Eigen::VectorXd expected = settings.m_step * A0.llt().solve(flat(impulses));
    EXPECT_LE((moved - expected).norm(), 1e-5 * expected.norm());
    EXPECT_LE(largestDistance(body.m_state.m_v, std::vector<Vec3>(X.size())), 1e-14);

    const std::vector<Vec3> x = body.m_state.m_x;
    solveFreeMotion(body, settings);
    const std::vector<Vec3> v = velocity(body);
    finishStep(body, settings);
    for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_LE(norm(body.m_state.m_x[i] - x[i] - settings.m_step * v[i]), 1e-15);
}

// The unresolved part of the velocities, which the end of a step removes, has no momentum at the pushed positions.
TEST(Parts, PushesOfHeldBodiesChangeAngularMomentumByWhatTheyTell)
{
    Body body = makeBody(makeBox({1, 0.6, 0.5}, {3, 2, 2}), elasticMaterial(1e5, 0.3));
    body.m_loads.m_isHeld = true;
    StepSettings settings;
    settings.m_numericalDamping = 0;
    RandomVectors random(7);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        body.m_state.m_v[i] = random.next() + cross({0, 3, 1}, body.m_state.m_x[i]);
    const Vec3 before = angularMomentum(body.m_state);
    solveFreeMotion(body, settings);
    std::vector<Vec3> impulses(body.m_state.m_x.size());
    impulses.front() = {3, -1, 2};
    const Vec3 gained = applyPositionCorrection(body, impulses, settings);
    finishStep(body, settings);
    EXPECT_GT(norm(gained), 1e-6 * norm(before));
    EXPECT_LE(norm(angularMomentum(body.m_state) - before - gained), 1e-13 * norm(before));
}

}  // namespace
}  // namespace bullet_fem
