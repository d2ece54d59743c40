// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "benchmarks/beam/beam_case.h"
#include "bullet_fem/fem/body/step_types.h"
#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// Rest shape and factor of the beam, clamped nodes eliminated. Throws std::invalid_argument.
std::shared_ptr<const BodyModel> makeBeamModel(const BeamCase& beam, FactorChoice choice = FactorChoice::full);

/// Runs the beam with BulletFEM's step, at the beam's step size; that of `settings` is ignored. The residual is
/// computed after each step from its velocities, outside the timed section. Throws std::invalid_argument.
BeamRun runFem(const BeamCase& beam, StepSettings settings, FactorChoice choice = FactorChoice::full);

}  // namespace bullet_fem
