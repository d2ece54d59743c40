// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// The motion of a body from x to x+ in a step: first to y, where the forces of the step act, then onward with the
/// velocities that they cause. All functions write to the body's scratch.

/// Kick position y = x + (1 - theta) h v; fixed nodes move with their target velocities.
void beginDrift(Body& body, const StepSettings& settings);

/// After the free motion's solve: moves the nodes also by the share (1 - theta) of an external change of velocities,
/// applied as impulses through the precomputed factor, as contact impulses are. Before, only its rigid part is
/// included.
void driftByOutsideChange(Body& body, const StepSettings& settings);

/// Computes the nodes' mean velocities in the free motion, whose end velocities are in the scratch.
void noteMeanVelocity(Body& body, const StepSettings& settings);

/// Position x+ = y + theta h v* + h push.
void endDrift(Body& body, const StepSettings& settings);

}  // namespace bullet_fem
