// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// How a body gets from x to x+ in a step: first to y, where the forces of the step act, then on with the velocities
/// that they make. What each function writes is in the body's scratch.

/// y = x + (1 - theta) h v; fixed nodes go with their target velocities.
void beginDrift(Body& body, const StepSettings& settings);

/// After the free motion's solve: a change of velocities from outside moves the nodes by the share (1 - theta), too, as
/// elements let it: by the precomputed factor, as impulses of contact do. Until then only its rigid motion has.
void driftByOutsideChange(Body& body, const StepSettings& settings);

/// When the velocities of the free motion stand in the scratch: with which mean velocities the nodes move by them.
void noteMeanVelocity(Body& body, const StepSettings& settings);

/// x+ = y + theta h v* + h push.
void endDrift(Body& body, const StepSettings& settings);

}  // namespace bullet_fem
