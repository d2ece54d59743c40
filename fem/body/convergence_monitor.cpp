// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/convergence_monitor.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

// Minimum residual norm: the square of a smaller one underflows.
constexpr double kMinResidual = 1e-150;

// The recurrence's residual drifts from the true one by about the rounding of A per iteration, 1e-6 |b| in single
// precision. It is trusted where this is far below the tolerance.
constexpr double kTrustedTolerance = 1e-4;
constexpr int kTrustedIterations = 8;

// An initial guess must be better than an iterated answer to be accepted unchanged: its error is that of the previous
// step, and would accumulate from step to step.
constexpr double kGuessToleranceShare = 0.1;

}  // namespace

double optimalScale(double bx, double xAx)
{
    const double best = bx / xAx;
    return best > 0 && std::isfinite(best) ? best : 0;
}

ConvergenceMonitor::ConvergenceMonitor(const ConjugateGradientStop& stop, double bNorm, bool zero)
    : m_stop(stop),
      m_bNorm(bNorm),
      m_goal(std::max(stop.m_tolerance * std::max(bNorm, stop.m_floor), kMinResidual)),
      m_rNorm(bNorm),
      m_guessed(!zero || stop.m_steady),
      m_over(false)
{
}

bool ConvergenceMonitor::noteGuess(double rNorm)
{
    m_rNorm = rNorm;
    return m_rNorm <= kGuessToleranceShare * m_goal;
}

bool ConvergenceMonitor::wantsTrueResidual() const
{
    return m_rNorm <= m_goal && !m_residualIsTrue;
}

void ConvergenceMonitor::noteTrueResidual(double rNorm)
{
    m_rNorm = rNorm;
    m_residualIsTrue = true;
    m_rz = 0;  // restart from here if the recurrence had drifted
}

bool ConvergenceMonitor::isSolved() const
{
    const double share = m_report.m_iterations == 0 && m_guessed ? kGuessToleranceShare : 1;
    return m_rNorm <= share * m_goal && std::isfinite(m_goal);
}

bool ConvergenceMonitor::decide()
{
    if (!m_over && isSolved())
        m_over = true;
    else if (!m_over && m_report.m_iterations == m_stop.m_maxIterations)
    {
        m_report.m_stop = SolveStop::budget;
        m_over = true;
    }
    return m_over && !m_residualIsTrue;
}

void ConvergenceMonitor::noteLastResidual(double rNorm)
{
    m_rNorm = rNorm;
    m_residualIsTrue = true;
}

bool ConvergenceMonitor::step(double rz, double pAp, double& step)
{
    step = rz / pAp;
    if (rz > 0 && pAp > 0 && std::isfinite(step)) return true;
    m_report.m_stop = SolveStop::breakdown;
    m_over = true;
    return false;
}

void ConvergenceMonitor::noteStep(double rz, double rNorm)
{
    m_rz = rz;
    m_rNorm = rNorm;
    ++m_report.m_iterations;
    m_residualIsTrue = m_stop.m_tolerance >= kTrustedTolerance && m_report.m_iterations <= kTrustedIterations;
}

SolveReport ConvergenceMonitor::report() const
{
    SolveReport report = m_report;
    const double scale = std::max(m_bNorm, m_stop.m_floor);
    report.m_residual = scale > 0 ? m_rNorm / scale : 0;
    return report;
}

}  // namespace bullet_fem
