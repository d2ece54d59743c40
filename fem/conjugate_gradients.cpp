// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/conjugate_gradients.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr double kNothing =
    1e-150;  // a residual below it has a square that is lost to rounding: nothing is left to solve

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

}  // namespace

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
    return sum;
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
    if (dot(x, x) > 0)
        trueResidual(A, b, x, r);
    else
        r = b;
    double rNorm = std::sqrt(dot(r, r));
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
        if (rNorm <= goal && std::isfinite(goal))
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
        residualIsTrue = false;
        ++report.m_iterations;
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
