// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The solves of stepping.h for several bodies at once, each bitwise equal to that of the body alone.
#pragma once

#include "bullet_fem/fem/body/step_types.h"
#include "fem/body/batch_width.h"

namespace bullet_fem
{

/// Minimum number of bodies in a batch; fewer are faster one after another, as the time of a batch is independent of
/// their number.
constexpr int kSmallestBatch = 6;

/// True if a body may be solved side by side with others of its model: a single connected component without fixed
/// nodes, single precision, nodal warp, and no special features (initial stress, actuators, frame damping, nonlinear
/// law).
bool canBeBatched(const FreeMotion& motion);
bool canBeBatched(const ImpulseResponse& response);
bool canBeBatched(const StepEnd& end);

/// True if two such bodies may share a batch: equal solver settings, and equal step variation in the free motion.
bool areEqual(const FreeMotion& a, const FreeMotion& b);
bool areEqual(const ImpulseResponse& a, const ImpulseResponse& b);
bool areEqual(const StepEnd& a, const StepEnd& b);

/// Solves up to kBatchWidth bodies of one model that are pairwise areEqual(). Returns false without any effect if they
/// are too few or memory cannot be allocated.
bool solveBatched(FreeMotion* const* motions, int count);
bool solveBatched(ImpulseResponse* const* responses, int count);
bool solveBatched(StepEnd* const* ends, int count);

}  // namespace bullet_fem
