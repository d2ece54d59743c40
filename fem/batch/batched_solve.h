// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The solves of stepping.h for several bodies at once. Every body gets the bits that it gets alone.
#pragma once

#include "bullet_fem/fem/body/step_types.h"
#include "fem/body/batch_width.h"

namespace bullet_fem
{

/// Fewer bodies are solved sooner one after another: a batch takes as long however many it has.
constexpr int kSmallestBatch = 6;

/// True if a body may be solved side by side with others of its model: of one piece, none of whose nodes are fixed,
/// solved in single precision and with the nodal warp, with nothing but what most bodies have.
bool canBeBatched(const FreeMotion& motion);
bool canBeBatched(const ImpulseResponse& response);
bool canBeBatched(const StepEnd& end);

/// True if the settings of two such bodies allow it, and what they have been through.
bool areAlike(const FreeMotion& a, const FreeMotion& b);
bool areAlike(const ImpulseResponse& a, const ImpulseResponse& b);
bool areAlike(const StepEnd& a, const StepEnd& b);

/// Solves up to kBatchWidth bodies of one model for which that is true. False, and nothing was done, if they are too
/// few or there is no memory for it.
bool solveBatched(FreeMotion* const* motions, int count);
bool solveBatched(ImpulseResponse* const* responses, int count);
bool solveBatched(StepEnd* const* ends, int count);

}  // namespace bullet_fem
