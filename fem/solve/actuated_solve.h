// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"
#include "fem/body/convergence_monitor.h"

namespace bullet_fem
{

/// Of which right-hand side a system is.
enum class SolveOf
{
    freeMotion,  ///< Actuation::addForces has told what of it is the actuators'
    response,    ///< impulses: none is
    change       ///< Actuation::setRightSide has told it
};

// For bodies with chambers or cables alone (Actuators::hasPulls).

/// The actuators at the positions and velocities of the step that begins, which the scratch has.
void beginActuation(Body& body, const StepSettings& settings);

/// h times the norm of the actuators' forces [N s], about: for the tolerance of the solve.
double actuatorImpulseNorm(const Body& body);

/// Solves A x = b for the increment and the right-hand side of the scratch. In the free motion cables that would push
/// are let go, and the rest is solved once more.
SolveReport solveActuated(Body& body, const StepSettings& settings, const ConjugateGradientStop& stop, bool isGuessed,
                          SolveOf what);

}  // namespace bullet_fem
