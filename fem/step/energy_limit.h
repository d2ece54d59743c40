// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"

namespace bullet_fem
{

/// Limits the energy of a step (docs/theory.md, Energy). A step takes its forces as linear in the motion, so elements
/// that turn far within it are stretched along chords, and gain energy from nothing.
///
/// If the kinetic and elastic energy at the end of the step exceeds that before it plus the work of loads, contacts and
/// joints by more than a share of all these, the step is solved again with full numerical damping, and if that does not
/// suffice, the body turns along arcs and its elastic motion is shortened. Momenta stay. Bodies that moving fixed nodes
/// or actuators drive are not limited: their work is unknown here.
///
/// Call after the last impulses, when the unresolved part of the velocities is known, of which `unresolved` is removed
/// [-]; 0 afterwards if the step was solved again. Returns true if it changed the step. Never allocates.
bool limitEnergy(Body& body, const StepSettings& settings, double& unresolved);

}  // namespace bullet_fem
