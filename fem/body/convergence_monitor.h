// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/step_types.h"

namespace bullet_fem
{

struct ConjugateGradientStop
{
    double m_tolerance = 1e-3;  ///< stop at |r| <= tolerance max(|b|, floor)
    double m_floor = 0;         ///< in the units of b, >= 0
    int m_maxIterations = 100;  ///< >= 1
    bool m_steady = false;  ///< the guess is the solution of a similar step, possibly 0, and b may cancel: the unscaled
                            ///< guess must meet a tighter tolerance, and residuals are relative to max(|b|, floor)
};

/// Stopping logic of the conjugate gradients of one body: from norms and products of the vectors it decides on the next
/// action of the solve and reports the result.
class ConvergenceMonitor
{
public:
    ConvergenceMonitor() = default;

    /// Starts with |b|. `zero`: the initial guess is zero, so that its residual need not be computed.
    ConvergenceMonitor(const ConjugateGradientStop& stop, double bNorm, bool zero);

    /// Receives |b - A x| of the guess. Returns true if the guess is good enough as it is; otherwise it is to be scaled
    /// by optimalScale().
    bool noteGuess(double rNorm);
    void noteScaledGuess(double rNorm) { m_rNorm = rNorm; }

    /// True if the recurrence's residual may be small by rounding error only; noteTrueResidual() is to be called then.
    bool wantsTrueResidual() const;
    void noteTrueResidual(double rNorm);

    /// Decides whether the solve is over, after these. Returns true if it is over and the true residual is still
    /// unknown.
    bool decide();
    void noteLastResidual(double rNorm);

    bool isOver() const { return m_over; }

    /// Coefficient of the next direction z + beta p, from r . z.
    double beta(double rz) const { return m_rz > 0 ? rz / m_rz : 0; }

    /// Step length along the direction, from r . z and p . A p. Returns false and ends the solve if the system is not
    /// positive definite or not finite.
    bool step(double rz, double pAp, double& step);

    /// Records the norms after the step.
    void noteStep(double rz, double rNorm);

    /// The report of a finished solve.
    SolveReport report() const;

private:
    bool isSolved() const;

    ConjugateGradientStop m_stop;
    SolveReport m_report;
    double m_bNorm = 0, m_goal = 0, m_rNorm = 0;
    double m_rz = 0;  // r . z of the previous iteration; 0: restart
    bool m_guessed = false, m_residualIsTrue = true, m_over = true;
};

/// The optimal scale (b . x) / (x . A x) of a guess x, which minimizes its error, or 0 if it is not positive and
/// finite.
double optimalScale(double bx, double xAx);

}  // namespace bullet_fem
