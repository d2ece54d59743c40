// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "fem/body/convergence_monitor.h"

namespace bullet_fem
{

/// Smoothing at the end of a step of less than full numerical damping: removes the unresolved part of the velocities,
///
///     v+ = v* - d A^-1 (A - M) (v* - v),
///
/// which changes slow motion to second order only. v* - v is the total change in the step, contact and joint impulses
/// included, so that a body at rest loses nothing. StepCoefficients has d.

/// Writes v* - v without its rigid part to the scratch's m_increment. Returns false if it is negligible, if the step is
/// implicit Euler, or if joints act on the body: smoothing would take the velocities at their ends apart, and the next
/// step's kick would act at positions that no joint holds, which adds energy.
bool findChange(Body& body, const StepSettings& settings);

/// Stopping rule of the smoothing solve; its floor is in the units of the right-hand side (A - M) (v* - v).
ConjugateGradientStop smoothingStop(const Body& body, const StepSettings& settings);

}  // namespace bullet_fem
