// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/increment_solve.h"

#include <utility>

namespace bullet_fem
{
namespace
{

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

}  // namespace

StepSettings sharedSettings(const BodyModel& model, StepSettings settings)
{
    if (model.nodeCount() < kNodesToShare) settings.m_threads = nullptr;
    return settings;
}

void completeIncrement(Body& body)
{
    StepScratch& scratch = body.m_workspace.scratch();
    std::vector<Vec3>& dv = scratch.m_increment;
    for (std::size_t i = 0; i < dv.size(); ++i) dv[i] += scratch.m_velocity[i];
    scratch.m_momentum.restore(body, dv);
    for (std::size_t i = 0; i < dv.size(); ++i) dv[i] -= scratch.m_velocity[i];
}

IncrementSolve::IncrementSolve(Body& body, const StepSettings& settings, const IncrementGoal& goal)
    : m_body(body),
      m_scratch(body.m_workspace.scratch()),
      m_settings(settings),
      m_A(body, settings.m_threads),
      m_solve({&m_A, &m_scratch.m_rightSide, &m_scratch.m_increment}, stopOf(settings, goal), m_scratch.m_solver)
{
}

PreconditionedVector IncrementSolve::wanted() const
{
    return {&m_body, &m_scratch.m_solver.m_r, &m_scratch.m_solver.m_z};
}

SolveReport IncrementSolve::addToVelocity()
{
    std::vector<Vec3>& v = m_scratch.m_velocity;
    for (std::size_t i = 0; i < v.size(); ++i)
        if (!m_body.m_state.m_fixed[i]) v[i] += m_scratch.m_increment[i];
    if (m_settings.m_momentumCorrection) m_scratch.m_momentum.restore(m_body, v);
    return m_solve.report();
}

void swapPassing(StepScratch& a, StepScratch& b)
{
    std::swap(a.m_solver, b.m_solver);
    std::swap(a.m_factor, b.m_factor);
    std::swap(a.m_elements.m_x, b.m_elements.m_x);
    std::swap(a.m_elements.m_v, b.m_elements.m_v);
    std::swap(a.m_elements.m_single.m_corners, b.m_elements.m_single.m_corners);
}

// To be called again to take it back.
void IncrementSolves::lend(Slot& slot, Body& body)
{
    if (!slot.m_first) slot.m_first = &body;
    if (slot.m_first != &body) swapPassing(slot.m_first->m_workspace.scratch(), body.m_workspace.scratch());
}

// One iteration of all that are at work; false if nobody is.
bool IncrementSolves::advance()
{
    PreconditionedVector wanted[kPanelGroup];
    int count = 0;
    for (const Slot& slot : m_slots)
        if (slot.m_solve) wanted[count++] = slot.m_solve->wanted();
    if (count == 0) return false;
    applyWarpedPreconditioner(wanted, count, m_threads);
    for (Slot& slot : m_slots)
        if (slot.m_solve) slot.m_solve->resume();
    return true;
}

}  // namespace bullet_fem
