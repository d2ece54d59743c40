// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/body/convergence_monitor.h"

namespace bullet_fem
{

/// The end of a step of less than full numerical damping: what the step does not resolve goes from the velocities,
///
///     v+ = v* - d A^-1 (A - M) (v* - v),
///
/// which leaves slow motion alone to second order. The change v* - v is all that the step did, impulses of contact and
/// joints included, so that nothing is taken from a body at rest. StepCoefficients has d.

/// Writes v* - v, less what is rigid motion, to the scratch's m_increment. False if there is too little of it to
/// matter, or if the step is implicit Euler. Takes the prescribed momentum.
bool findChange(Body& body, const StepSettings& settings);

/// When that has been solved for. `floor` in the units of its right-hand side (A - M) (v* - v).
ConjugateGradientStop smoothingStop(const Body& body, const StepSettings& settings);

/// v* -= d times m_increment, which gives no momentum at the positions of the step's end.
void subtractUnresolved(Body& body, const StepSettings& settings);

}  // namespace bullet_fem
