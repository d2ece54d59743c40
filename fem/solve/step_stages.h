// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/step_types.h"
#include "fem/body/convergence_monitor.h"

namespace bullet_fem
{

// The step, stage by stage. The template parameter Width implements the stages: OneBody for a single body, BodyBatch
// for up to kBatchWidth bodies of one model, each bitwise equal to the single one. This file defines the order of the
// stages.

/// The free motion, without contact [docs/theory.md, One step]: the rigid part of the velocities follows from the
/// momenta, and the elastic part w of the kick velocities u gains e,
///
///     Pi^T A e = Pi^T b   A = (1 + h alpha) M + (c h^2 + h beta) K' + c h^2 T        K' = sum R_e K_e R_e^T
///                         b = h (f_ext + f_el(y) - alpha M u - (s h + beta) K' w) - r c h^2 T w + centrifugal impulses
///
/// with c, theta and s of StepCoefficients (implicit Euler: c = theta = s = 1), Pi^T of RigidMomentum, and r from the
/// variation of the recent steps.
template <class Width>
void solveFreeMotion(Width& width)
{
    width.readState();             // y, u, M and the loads f_ext
    width.prescribeMomentum();     // linear and angular momentum that the loads prescribe for every free component
    width.passOverElements();      // rotations R_e, elastic forces f_el, A; and b
    width.averageRotations();      // R_i of the preconditioner R A0^-1 R^T, one per node or one for the body
    width.eliminateFixedNodes();   // b_f -= A_fp dv_p
    width.addPredictedImpulses();  // adds contact's to b and to the prescribed momentum
    width.guessIncrement();        // warm start of e from the last steps
    width.solve();                 // conjugate gradients: Pi^T A e = Pi^T b to the tolerance
    width.correctIncrement();      // quasi-Newton iterations for nonlinear laws
    width.addIncrement();          // u += e, plus the rigid motion that has the prescribed momentum
    width.keepIncrement();         // for the warm start of the next step
}

/// The response to contact and joint impulses, any number of times after the free motion: Pi^T A e = Pi^T (J + r), with
/// r the residual of the previous responses.
template <class Width>
void respondToImpulses(Width& width)
{
    width.readImpulses();    // J, and the present v
    width.completeSystem();  // A and R_i, if the free motion left them out
    width.addMomentum();     // adds J to the prescribed momentum
    width.addResidual();     // r
    width.guessResponse();   // initial guess: zero, or the return to the velocities at the start of the step
    width.solve();
    width.addIncrement();
    width.keepResidual();
}

/// After the last impulses: the unresolved part of the change of elastic velocities (smoothing.h).
template <class Width>
void findUnresolved(Width& width)
{
    width.readChange();      // v* - v
    width.completeSystem();  // A and R_i, if they were left out
    width.applyStiffness();  // b = (A - M) (v* - v)
    width.solve();           // to a few hundredths of M (v* - v)
    width.keepUnresolved();
}

/// Stopping rule of a body's conjugate gradients; `floor` and `isSteady` as in ConjugateGradientStop.
inline ConjugateGradientStop stopOf(const StepSettings& settings, double floor, bool isSteady)
{
    ConjugateGradientStop stop;
    stop.m_tolerance = settings.m_tolerance;
    stop.m_floor = floor;
    stop.m_steady = isSteady;
    stop.m_maxIterations = settings.m_direct ? 1 : settings.m_maxIterations;
    return stop;
}

/// Lower bound of |b| as a share of the loads' impulse h |f_ext|, for the tolerance [-]: at rest b tends to zero.
constexpr double kLoadFloor = 1e-3;

}  // namespace bullet_fem
