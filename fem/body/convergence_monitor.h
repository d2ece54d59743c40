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
    bool m_steady = false;      ///< x is the answer of a step like this one, be it 0, and b may cancel: as it
                                ///< stands it must be better, and residuals are of max(|b|, floor)
};

/// Watches the conjugate gradients of one body: by the norms and products of its vectors it tells what the solve does
/// next, and what it has come to.
class ConvergenceMonitor
{
public:
    ConvergenceMonitor() = default;

    /// Starts with |b|; `zero`: so is the guess, which then needs no residual.
    ConvergenceMonitor(const ConjugateGradientStop& stop, double bNorm, bool zero);

    /// |b - A x| of the guess. True if it is good enough as it is; else its best multiple is to be taken:
    /// optimalScale().
    bool noteGuess(double rNorm);
    void noteScaledGuess(double rNorm) { m_rNorm = rNorm; }

    /// True if the recurrence's residual may be small only by its errors: then the true one is to be told.
    bool wantsTrueResidual() const;
    void noteTrueResidual(double rNorm);

    /// To be called when that is done: the solve may be over. True if it is, and the true residual is not known yet.
    bool decide();
    void noteLastResidual(double rNorm);

    bool isOver() const { return m_over; }

    /// For the next direction, z + beta p, by r . z.
    double beta(double rz) const { return m_rz > 0 ? rz / m_rz : 0; }

    /// How far along it, by r . z and p . A p: false if the system turned out not to be positive definite, or not
    /// finite: then the solve is broken off.
    bool step(double rz, double pAp, double& step);

    /// After the step.
    void noteStep(double rz, double rNorm);

    /// Of a solve that is over.
    SolveReport report() const;

private:
    bool isSolved() const;

    ConjugateGradientStop m_stop;
    SolveReport m_report;
    double m_bNorm = 0, m_goal = 0, m_rNorm = 0;
    double m_rz = 0;  // r . z of the iteration before; 0: the next one starts anew
    bool m_guessed = false, m_residualIsTrue = true, m_over = true;
};

/// The factor by which a guess x leaves the smallest error, or 0 if that is no good: (b . x) / (x . A x).
double optimalScale(double bx, double xAx);

}  // namespace bullet_fem
