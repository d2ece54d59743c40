// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/drift.h"

#include "fem/step/step_coefficients.h"
#include "fem/step/step_scratch.h"

namespace bullet_fem
{

void beginDrift(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const BodyState& s = body.m_state;
    const double first = 1 - StepCoefficients(settings).theta();
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        scratch.m_drift[i] = first * (s.m_fixed[i] ? body.m_loads.m_targetVelocity[i] : s.m_v[i]);
        scratch.m_kickPosition[i] = s.m_x[i] + settings.m_step * scratch.m_drift[i];
    }
}

void noteMeanVelocity(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const double theta = StepCoefficients(settings).theta();
    for (std::size_t i = 0; i < scratch.m_drift.size(); ++i)
        scratch.m_meanVelocity[i] = scratch.m_drift[i] + theta * scratch.m_velocity[i];
}

void endDrift(Body& body, const StepSettings& settings)
{
    const StepScratch& scratch = body.m_workspace.scratch();
    std::vector<Vec3>& x = body.m_state.m_x;
    const double h = settings.m_step, second = h * StepCoefficients(settings).theta();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = scratch.m_kickPosition[i] + second * scratch.m_velocity[i];
    for (std::size_t i = 0; i < x.size() && scratch.m_isPushed; ++i) x[i] += h * scratch.m_push[i];
}

}  // namespace bullet_fem
