// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/step/body.h"

namespace bullet_fem
{

/// Smaller bodies are solved in less time than it takes to share one out: nodes, of some 5 tets each.
constexpr int kNodesToShare = 1000;

/// The settings with the threads that may work on a body of this model: none if it is too small.
StepSettings sharedSettings(const BodyModel& model, StepSettings settings);

/// What an increment is solved to.
struct IncrementGoal
{
    double m_floor = 0;     ///< of |b| for the tolerance [kg m/s], >= 0
    bool m_steady = false;  ///< see ConjugateGradientStop
};

struct ConjugateGradientStop;

/// When the conjugate gradients of a body stop.
ConjugateGradientStop stopOf(const StepSettings& settings, const IncrementGoal& goal);

/// Adds to the increment in a body's scratch, the guess of a solve, the rigid motion of free pieces that gives them the
/// momentum prescribed.
void completeIncrement(Body& body);

/// Solves A dv = b of one body, as its scratch holds b and a guess of dv, and adds dv to the velocities of its free
/// nodes. Afterwards m_r of the scratch's solver is b - A dv, until the next solve.
SolveReport solveIncrement(Body& body, const StepSettings& settings, const IncrementGoal& goal);

}  // namespace bullet_fem
