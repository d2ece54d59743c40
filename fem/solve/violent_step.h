// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"

namespace bullet_fem
{

class Threads;

/// Strains of a step that is taken as it is [-]: of laws that are not linear, else corrections follow (QuasiNewton);
constexpr double kGentleStrain = 0.2;
/// and of Hooke's, in the first half of the motion. From .5 on, bars that are caught in flight get more energy than
/// they have (`CaughtInFlight`); with .3, balls that bounce by steps of second order lose more than they should
/// (`SecondOrderDrop`).
constexpr double kGentleStrainOfHooke = 0.4;

/// True if nodes that move by time (v + dv) strain an element by more than `gentle` [-], or by more than this share of
/// its present volume ratio, or if it is inside out: what is linear in a step is no answer then. `dv` may be null. Any
/// number of threads gives the same answer.
bool isViolent(const Body& body, double time, const std::vector<Vec3>& v, const std::vector<Vec3>* dv, double gentle,
               const Threads* threads);

/// Sets StepScratch::m_leastDamping for a step that begins: implicit Euler, which looks at forces before it moves,
/// where the first half of the motion would be violent. The velocities are those of the state.
void chooseDamping(Body& body, const StepSettings& settings);

}  // namespace bullet_fem
