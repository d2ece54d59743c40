// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/increment_solve.h"

#include "fem/step/step_scratch.h"
#include "fem/step/warped_system.h"

namespace bullet_fem
{

StepSettings sharedSettings(const BodyModel& model, StepSettings settings)
{
    if (model.nodeCount() < kNodesToShare) settings.m_threads = nullptr;
    return settings;
}

ConjugateGradientStop stopOf(const StepSettings& settings, const IncrementGoal& goal)
{
    ConjugateGradientStop stop;
    stop.m_tolerance = settings.m_tolerance;
    stop.m_floor = goal.m_floor;
    stop.m_steady = goal.m_steady;
    stop.m_maxIterations = settings.m_direct ? 1 : settings.m_maxIterations;
    stop.m_threads = settings.m_threads;
    return stop;
}

void completeIncrement(Body& body)
{
    StepScratch& scratch = body.m_workspace.scratch();
    std::vector<Vec3>& dv = scratch.m_increment;
    for (std::size_t i = 0; i < dv.size(); ++i) dv[i] += scratch.m_velocity[i];
    scratch.m_momentum.restore(body, dv);
    for (std::size_t i = 0; i < dv.size(); ++i) dv[i] -= scratch.m_velocity[i];
}

SolveReport solveIncrement(Body& body, const StepSettings& settings, const IncrementGoal& goal)
{
    StepScratch& scratch = body.m_workspace.scratch();
    std::vector<Vec3>&dv = scratch.m_increment, &v = scratch.m_velocity;
    const WarpedSystem A(body, settings.m_threads);
    const WarpedPreconditioner P(body, settings.m_threads);
    const SolveReport report =
        solveConjugateGradients(A, P, scratch.m_rightSide, stopOf(settings, goal), scratch.m_solver, dv);
    for (std::size_t i = 0; i < v.size(); ++i)
        if (!body.m_state.m_fixed[i]) v[i] += dv[i];
    if (settings.m_momentumCorrection) scratch.m_momentum.restore(body, v);
    return report;
}

}  // namespace bullet_fem
