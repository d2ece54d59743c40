// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The step of a body alone: the widths of step_stages.h for one.
#pragma once

#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{

/// The settings with the threads that may work on a body of this model: none if it is too small.
StepSettings sharedSettings(const BodyModel& model, StepSettings settings);

/// On the threads of the settings, or without them where the body is too small.
void solveAlone(FreeMotion& motion);
void solveAlone(ImpulseResponse& response);
void solveAlone(StepEnd& end);

}  // namespace bullet_fem
