// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The step of a single body: implements the stages of step_stages.h.
#pragma once

#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{

/// The settings, without threads if a body of this model is too small to share.
StepSettings sharedSettings(const BodyModel& model, StepSettings settings);

/// Solves one job on the threads of its settings, or without them if the body is too small to share.
void solveAlone(FreeMotion& motion);
void solveAlone(ImpulseResponse& response);
void solveAlone(StepEnd& end);

}  // namespace bullet_fem
