// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/step_variation.h"

#include <algorithm>

#include "fem/body/step_scratch.h"

namespace bullet_fem
{

void noteStep(Body& body, double step)
{
    BodyState& state = body.m_state;
    const bool isFirst = !(state.m_leastStep > 0);
    state.m_leastStep = isFirst ? step : std::min(step, state.m_leastStep * kForgottenByStep);
    state.m_mostStep = std::max(step, state.m_mostStep / kForgottenByStep);
    const double ratio = state.m_leastStep / state.m_mostStep;
    body.m_workspace.scratch().m_stepVariation = 1 - ratio * ratio;
}

}  // namespace bullet_fem
