// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"
#include "fem/body/convergence_monitor.h"

namespace bullet_fem
{

/// The origin of a right-hand side.
enum class SolveOf
{
    freeMotion,  ///< free motion; Actuation::addForces has recorded the actuators' part
    response,    ///< impulses; no actuators' part
    change       ///< change of velocities; Actuation::setRightSide has recorded the actuators' part
};

// For bodies with chambers or cables only (Actuators::hasPulls).

/// Evaluates the actuators at the kick positions and velocities in the body's scratch, at the start of a step.
void beginActuation(Body& body, const StepSettings& settings);

/// Approximately h times the norm of the actuators' forces [N s], for the tolerance of the solve.
double actuatorImpulseNorm(const Body& body);

/// Solves A x = b for the increment and the right-hand side in the body's scratch. In the free motion, cables that
/// would push are released, and the rest is solved again.
SolveReport solveActuated(Body& body, const StepSettings& settings, const ConjugateGradientStop& stop, bool isGuessed,
                          SolveOf what);

}  // namespace bullet_fem
