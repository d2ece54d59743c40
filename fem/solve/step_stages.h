// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/step_types.h"
#include "fem/body/convergence_monitor.h"

namespace bullet_fem
{

// The step, stage by stage. A width is who takes it: OneBody, or BodyBatch with up to kBatchWidth bodies of one model,
// each of which gets the bits that it gets alone. What the stages do is in the width; in which order is here.

/// The free motion, as if nothing touched the body [docs/theory.md]:
///
///     A dv = b        A = (1 + h alpha) M + (c h^2 + h beta) K' + c h^2 T        K' = sum R_e K_e R_e^T
///                     b = h (f_ext + f_el(y) - alpha M v - K' w) - r c h^2 T v    y = x + (1 - theta) h v
///
/// with w = (s h + beta) v but for what turns with the body, c, theta and s of StepCoefficients: implicit Euler with
/// c = theta = s = 1; and r of how the recent steps vary.
template <class Width>
void solveFreeMotion(Width& width)
{
    width.readState();             // y, v, M and the loads f_ext
    width.prescribeMomentum();     // linear and angular momentum that the loads give every free piece
    width.passOverElements();      // rotations R_e, elastic forces f_el, A; and b
    width.averageRotations();      // R_i, one a node, or the body's one: of the preconditioner R A0^-1 R^T
    width.eliminateFixedNodes();   // b_f -= A_fp dv_p
    width.addPredictedImpulses();  // of contact, to b and to the momentum prescribed
    width.guessIncrement();        // dv as in the last steps, with the rigid motion that gives the momentum prescribed
    width.solve();                 // conjugate gradients: A dv = b to the tolerance
    width.correctIncrement();      // quasi-Newton iterations, where the law is not linear
    width.addIncrement();          // v += dv, and the rigid motion that gives the momentum prescribed
    width.keepIncrement();         // for the guess of the next step
}

/// The response to impulses of contact and joints, any number of times after the free motion: A dv = J + r, with r what
/// the responses before it have left.
template <class Width>
void respondToImpulses(Width& width)
{
    width.readImpulses();    // J, and v as it is
    width.completeSystem();  // A and R_i, where the free motion left them out
    width.addMomentum();     // of J, to that prescribed
    width.addResidual();     // r
    width.guessResponse();   // nothing, or the way back to the velocities that the step began with
    width.solve();
    width.addIncrement();
    width.keepResidual();
}

/// Once no more impulses follow: what the step does not resolve of its change of velocities (smoothing.h).
template <class Width>
void findUnresolved(Width& width)
{
    width.readChange();      // v* - v
    width.completeSystem();  // as above
    width.applyStiffness();  // b = (A - M) (v* - v)
    width.solve();           // to a few hundredths of M (v* - v)
    width.keepUnresolved();
}

/// When the conjugate gradients of a body stop; `floor` and `isSteady` as in ConjugateGradientStop.
inline ConjugateGradientStop stopOf(const StepSettings& settings, double floor, bool isSteady)
{
    ConjugateGradientStop stop;
    stop.m_tolerance = settings.m_tolerance;
    stop.m_floor = floor;
    stop.m_steady = isSteady;
    stop.m_maxIterations = settings.m_direct ? 1 : settings.m_maxIterations;
    return stop;
}

/// Share of the loads' impulse h |f_ext| that |b| counts as at least, for the tolerance [-]: at rest b tends to zero.
constexpr double kLoadFloor = 1e-3;

}  // namespace bullet_fem
