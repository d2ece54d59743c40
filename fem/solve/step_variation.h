// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// Factor by which each step moves the maximum and minimum of the recent steps towards itself [-]: a step of a quarter
/// of the others is forgotten after 15 steps.
constexpr double kForgottenByStep = 1.1;

/// Updates the body's recent steps with a step that begins [s], and sets StepScratch::m_stepVariation.
void noteStep(Body& body, double step);

}  // namespace bullet_fem
