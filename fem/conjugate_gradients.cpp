// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/conjugate_gradients.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

// A residual below it has a square that is lost to rounding: nothing is left to solve.
constexpr double kNothing = 1e-150;

// The recurrence's residual drifts from the true one by about the rounding of A, 1e-6 |b| in single precision, an
// iteration. It is believed where that is far below the tolerance.
constexpr double kTrustedTolerance = 1e-4;
constexpr int kTrustedIterations = 8;

// A guess that is good enough as it stands must be better than an iteration's answer would have to be: its error is
// that of the step before, and would be carried on from step to step.
constexpr double kGuessShare = 0.1;

// y += s x.
void axpy(double s, const std::vector<Vec3>& x, std::vector<Vec3>& y)
{
    for (std::size_t i = 0; i < x.size(); ++i) y[i] += s * x[i];
}

// r = b - A x, by an application of A.
void trueResidual(const LinearOperator& A, const std::vector<Vec3>& b, const std::vector<Vec3>& x, std::vector<Vec3>& r)
{
    A.apply(x, r);
    for (std::size_t i = 0; i < b.size(); ++i) r[i] = b[i] - r[i];
}

// Scales a guess x by its optimal step length, so that it is never worse than none; r becomes b - A x. A x is given.
void scaleGuess(const std::vector<Vec3>& Ax, const std::vector<Vec3>& b, std::vector<Vec3>& x, std::vector<Vec3>& r)
{
    const double best = dot(b, x) / dot(x, Ax);
    const double scale = best > 0 && std::isfinite(best) ? best : 0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        x[i] *= scale;
        r[i] = scale > 0 ? b[i] - scale * Ax[i] : b[i];
    }
}

}  // namespace

// Four sums, so that an addition need not wait for the one before it; their order is fixed.
double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double sum[4] = {};
    std::size_t i = 0;
    for (; i + 4 <= a.size(); i += 4)
        for (int k = 0; k < 4; ++k) sum[k] += dot(a[i + k], b[i + k]);
    for (; i < a.size(); ++i) sum[0] += dot(a[i], b[i]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

SolveReport solveConjugateGradients(const LinearOperator& A, const LinearOperator& P, const std::vector<Vec3>& b,
                                    const ConjugateGradientStop& stop, ConjugateGradientScratch& scratch,
                                    std::vector<Vec3>& x)
{
    std::vector<Vec3>&r = scratch.m_r, &z = scratch.m_z, &p = scratch.m_p, &Ap = scratch.m_Ap;
    const double bNorm = std::sqrt(dot(b, b));
    const double goal = std::max(stop.m_tolerance * std::max(bNorm, stop.m_floor), kNothing);
    SolveReport report;
    bool residualIsTrue = true;
    r = b;
    double rNorm = bNorm;
    const bool guessed = dot(x, x) > 0;
    if (guessed)
    {
        A.apply(x, Ap);
        for (std::size_t i = 0; i < b.size(); ++i) r[i] = b[i] - Ap[i];
        rNorm = std::sqrt(dot(r, r));
        if (!(rNorm <= kGuessShare * goal))
        {
            scaleGuess(Ap, b, x, r);
            rNorm = std::sqrt(dot(r, r));
        }
    }
    double rz = 0;
    report.m_stop = SolveStop::budget;
    for (;;)
    {
        if (rNorm <= goal && !residualIsTrue)
        {
            trueResidual(A, b, x, r);
            rNorm = std::sqrt(dot(r, r));
            residualIsTrue = true;
            rz = 0;  // restart from here if the recurrence had drifted
        }
        if (rNorm <= (report.m_iterations == 0 && guessed ? kGuessShare * goal : goal) && std::isfinite(goal))
        {
            report.m_stop = SolveStop::converged;
            break;
        }
        if (report.m_iterations == stop.m_maxIterations) break;

        P.apply(r, z);
        const double rzNew = dot(r, z);
        const double beta = rz > 0 ? rzNew / rz : 0;
        for (std::size_t i = 0; i < p.size(); ++i) p[i] = beta > 0 ? z[i] + beta * p[i] : z[i];
        A.apply(p, Ap);
        const double pAp = dot(p, Ap), step = rzNew / pAp;
        if (!(rzNew > 0) || !(pAp > 0) || !std::isfinite(step))
        {
            report.m_stop = SolveStop::breakdown;
            break;
        }
        axpy(step, p, x);
        axpy(-step, Ap, r);
        rz = rzNew;
        rNorm = std::sqrt(dot(r, r));
        ++report.m_iterations;
        residualIsTrue = stop.m_tolerance >= kTrustedTolerance && report.m_iterations <= kTrustedIterations;
    }
    if (!residualIsTrue)
    {
        trueResidual(A, b, x, r);
        rNorm = std::sqrt(dot(r, r));
    }
    report.m_residual = bNorm > 0 ? rNorm / bNorm : 0;
    return report;
}

}  // namespace bullet_fem
