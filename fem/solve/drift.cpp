// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/drift.h"

#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/solve/warped_compliance.h"

namespace bullet_fem
{

namespace
{

// The non-rigid part of an external change of velocities, which acts as impulses.
void findStrainedChange(Body& body, double step, std::vector<Vec3>& change)
{
    const BodyState& s = body.m_state;
    const std::vector<Vec3>& prior = body.m_loads.m_priorVelocity;
    for (std::size_t i = 0; i < change.size(); ++i) change[i] = s.m_fixed[i] ? Vec3() : s.m_v[i] - prior[i];
    body.m_workspace.scratch().m_momentum.removeMomentum(body, step, s.m_x, change);
}

}  // namespace

void beginDrift(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const BodyState& s = body.m_state;
    const double first = 1 - StepCoefficients(settings, body).theta();
    scratch.m_isStrained = first > 0 && !body.m_loads.m_priorVelocity.empty();
    if (scratch.m_isStrained) findStrainedChange(body, settings.m_step, scratch.m_strained);
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        const Vec3 v = s.m_fixed[i] ? body.m_loads.m_targetVelocity[i] : s.m_v[i];
        scratch.m_drift[i] = first * (scratch.m_isStrained ? v - scratch.m_strained[i] : v);
        scratch.m_kickPosition[i] = s.m_x[i] + settings.m_step * scratch.m_drift[i];
    }
}

void driftByOutsideChange(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    if (!scratch.m_isStrained) return;
    const double first = 1 - StepCoefficients(settings, body).theta();
    std::vector<Vec3>& impulses = scratch.m_strained;
    for (std::size_t i = 0; i < impulses.size(); ++i) impulses[i] *= first * body.m_state.m_mass[i];
    WarpedCompliance(body, settings.m_threads).apply(impulses, scratch.m_increment);
    for (std::size_t i = 0; i < impulses.size(); ++i)
    {
        scratch.m_push[i] = scratch.m_complianceScale * scratch.m_increment[i];
        scratch.m_drift[i] += scratch.m_push[i];
    }
    scratch.m_isPushed = true;
}

void noteMeanVelocity(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const double theta = StepCoefficients(settings, body).theta();
    for (std::size_t i = 0; i < scratch.m_drift.size(); ++i)
        scratch.m_meanVelocity[i] = scratch.m_drift[i] + theta * scratch.m_velocity[i];
}

void endDrift(Body& body, const StepSettings& settings)
{
    const StepScratch& scratch = body.m_workspace.scratch();
    std::vector<Vec3>& x = body.m_state.m_x;
    const double h = settings.m_step, second = h * StepCoefficients(settings, body).theta();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = scratch.m_kickPosition[i] + second * scratch.m_velocity[i];
    for (std::size_t i = 0; i < x.size() && scratch.m_isPushed; ++i) x[i] += h * scratch.m_push[i];
}

}  // namespace bullet_fem
