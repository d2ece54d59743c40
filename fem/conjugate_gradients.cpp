// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/conjugate_gradients.h"

#include <algorithm>

#include "fem/pieces.h"

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

// Calls update(i) for every node, which changes nothing but entries i.
template <class Update>
void forEachNode(const Threads* threads, std::size_t size, const Update& update)
{
    runRanges(threads, {static_cast<int>(size), kEntriesOfPiece},
              [&](Range nodes)
              {
                  for (int i = nodes.m_begin; i < nodes.m_end; ++i) update(i);
              });
}

// Four sums, so that an addition need not wait for the one before it; their order is fixed.
double dotOfRange(const std::vector<Vec3>& a, const std::vector<Vec3>& b, Range nodes)
{
    double sum[4] = {};
    int i = nodes.m_begin;
    for (; i + 4 <= nodes.m_end; i += 4)
        for (int k = 0; k < 4; ++k) sum[k] += dot(a[i + k], b[i + k]);
    for (; i < nodes.m_end; ++i) sum[0] += dot(a[i], b[i]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Threads* threads)
{
    const Pieces pieces(static_cast<int>(a.size()), kEntriesOfPiece);
    double sums[Pieces::kMost];
    runTasks(threads, pieces.count(), [&](int k) { sums[k] = dotOfRange(a, b, pieces[k]); });
    double sum = 0;
    for (int k = 0; k < pieces.count(); ++k) sum += sums[k];
    return sum;
}

namespace
{

/// What the solve does to vectors of nodes.
class NodeVectors
{
public:
    explicit NodeVectors(const Threads* threads) : m_threads(threads) {}

    double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) const
    {
        return bullet_fem::dot(a, b, m_threads);
    }
    double norm(const std::vector<Vec3>& a) const { return std::sqrt(dot(a, a)); }

    /// r = b - Ax.
    void residual(const std::vector<Vec3>& b, const std::vector<Vec3>& Ax, std::vector<Vec3>& r) const
    {
        forEachNode(m_threads, b.size(), [&](int i) { r[i] = b[i] - Ax[i]; });
    }

    /// p = z + beta p; z where beta is 0, whatever was in p.
    void turn(double beta, const std::vector<Vec3>& z, std::vector<Vec3>& p) const
    {
        forEachNode(m_threads, p.size(), [&](int i) { p[i] = beta > 0 ? z[i] + beta * p[i] : z[i]; });
    }

    /// x += step p, r -= step Ap.
    void advance(double step, const ConjugateGradientScratch& scratch, std::vector<Vec3>& x, std::vector<Vec3>& r) const
    {
        forEachNode(m_threads, x.size(),
                    [&](int i)
                    {
                        x[i] += step * scratch.m_p[i];
                        r[i] += -step * scratch.m_Ap[i];
                    });
    }

    /// Scales a guess x by its optimal step length, so that it is never worse than none; r becomes b - A x.
    void scaleGuess(const std::vector<Vec3>& Ax, const std::vector<Vec3>& b, std::vector<Vec3>& x,
                    std::vector<Vec3>& r) const
    {
        const double best = dot(b, x) / dot(x, Ax);
        const double scale = best > 0 && std::isfinite(best) ? best : 0;
        forEachNode(m_threads, x.size(),
                    [&](int i)
                    {
                        x[i] *= scale;
                        r[i] = scale > 0 ? b[i] - scale * Ax[i] : b[i];
                    });
    }

private:
    const Threads* m_threads;
};

}  // namespace

SolveReport solveConjugateGradients(const LinearOperator& A, const LinearOperator& P, const std::vector<Vec3>& b,
                                    const ConjugateGradientStop& stop, ConjugateGradientScratch& scratch,
                                    std::vector<Vec3>& x)
{
    std::vector<Vec3>&r = scratch.m_r, &z = scratch.m_z, &p = scratch.m_p, &Ap = scratch.m_Ap;
    const NodeVectors vectors(stop.m_threads);
    const auto measureTruly = [&]  // r = b - A x, by an application of A
    {
        A.apply(x, Ap);
        vectors.residual(b, Ap, r);
        return vectors.norm(r);
    };
    const double bNorm = vectors.norm(b);
    const double goal = std::max(stop.m_tolerance * std::max(bNorm, stop.m_floor), kNothing);
    SolveReport report;
    bool residualIsTrue = true;
    r = b;
    double rNorm = bNorm;
    const bool guessed = vectors.dot(x, x) > 0;
    if (guessed) rNorm = measureTruly();
    if (guessed && !(rNorm <= kGuessShare * goal))
    {
        vectors.scaleGuess(Ap, b, x, r);
        rNorm = vectors.norm(r);
    }
    double rz = 0;
    report.m_stop = SolveStop::budget;
    for (;;)
    {
        if (rNorm <= goal && !residualIsTrue)
        {
            rNorm = measureTruly();
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
        const double rzNew = vectors.dot(r, z);
        const double beta = rz > 0 ? rzNew / rz : 0;
        vectors.turn(beta, z, p);
        A.apply(p, Ap);
        const double pAp = vectors.dot(p, Ap), step = rzNew / pAp;
        if (!(rzNew > 0) || !(pAp > 0) || !std::isfinite(step))
        {
            report.m_stop = SolveStop::breakdown;
            break;
        }
        vectors.advance(step, scratch, x, r);
        rz = rzNew;
        rNorm = vectors.norm(r);
        ++report.m_iterations;
        residualIsTrue = stop.m_tolerance >= kTrustedTolerance && report.m_iterations <= kTrustedIterations;
    }
    if (!residualIsTrue) rNorm = measureTruly();
    report.m_residual = bNorm > 0 ? rNorm / bNorm : 0;
    return report;
}

}  // namespace bullet_fem
