// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"

namespace bullet_fem
{

class Threads;

/// Maximum strain increment of a single linear solve for nonlinear laws [-]; larger ones need corrections
/// (QuasiNewton).
constexpr double kMaxStrainIncrement = 0.2;
/// Maximum strain increment in the first half of the motion for Hooke's law [-]. From .5 on, bars caught in flight gain
/// energy (`CaughtInFlight`); with .3, balls that bounce with second-order steps lose too much (`SecondOrderDrop`).
constexpr double kMaxStrainIncrementOfHooke = 0.4;

/// True if moving the nodes by time (v + dv) strains any element by more than `gentle` [-], changes its present volume
/// ratio by more than this share, or if it is inverted: a linear step is inaccurate then. `dv` may be null. Independent
/// of the number of threads.
bool exceedsStrainIncrement(const Body& body, double time, const std::vector<Vec3>& v, const std::vector<Vec3>* dv,
                            double gentle, const Threads* threads);

/// Sets StepScratch::m_leastDamping at the start of a step: implicit Euler, which evaluates forces before it moves, if
/// the first half of the motion with the state's velocities would exceed the strain limit.
void chooseDamping(Body& body, const StepSettings& settings);

}  // namespace bullet_fem
