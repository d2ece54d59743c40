// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// By how much a step moves the longest and the shortest of the recent ones towards itself [-]: a step of a quarter of
/// the others is forgotten after 15 of these.
constexpr double kForgottenByStep = 1.1;

/// Counts a step that begins [s] among the body's recent ones, and sets StepScratch::m_stepVariation.
void noteStep(Body& body, double step);

}  // namespace bullet_fem
