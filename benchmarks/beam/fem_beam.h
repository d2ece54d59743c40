// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "benchmarks/beam/beam_case.h"
#include "bullet_fem/fem/body/step_types.h"
#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// The beam's rest shape and factor, clamped nodes eliminated. Throws std::invalid_argument.
std::shared_ptr<const BodyModel> makeBeamModel(const BeamCase& beam, FactorChoice choice = FactorChoice::full);

/// Runs the beam with our own step; the step size is the beam's, whatever `settings` says. The residual is computed
/// anew after each step, outside the time taken, from the velocities that the step left. Throws std::invalid_argument.
BeamRun runFem(const BeamCase& beam, StepSettings settings, FactorChoice choice = FactorChoice::full);

}  // namespace bullet_fem
