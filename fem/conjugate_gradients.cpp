// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

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

ConjugateGradients::ConjugateGradients(const LinearProblem& problem, const ConjugateGradientStop& stop,
                                       ConjugateGradientScratch& scratch)
    : m_problem(problem), m_stop(stop), m_scratch(scratch)
{
    start();
    checkForEnd();
}

// r = b - A x, by an application of A.
double ConjugateGradients::measureTruly()
{
    const NodeVectors vectors(m_stop.m_threads);
    m_problem.m_A->apply(*m_problem.m_x, m_scratch.m_Ap);
    vectors.residual(*m_problem.m_b, m_scratch.m_Ap, m_scratch.m_r);
    return vectors.norm(m_scratch.m_r);
}

void ConjugateGradients::start()
{
    const NodeVectors vectors(m_stop.m_threads);
    const std::vector<Vec3>& b = *m_problem.m_b;
    std::vector<Vec3>& x = *m_problem.m_x;
    m_rNorm = m_bNorm = vectors.norm(b);
    m_goal = std::max(m_stop.m_tolerance * std::max(m_bNorm, m_stop.m_floor), kNothing);
    m_scratch.m_r = b;
    const bool zero = !(vectors.dot(x, x) > 0);
    m_guessed = !zero || m_stop.m_steady;
    if (zero) return;
    m_rNorm = measureTruly();
    if (m_rNorm <= kGuessShare * m_goal) return;
    vectors.scaleGuess(m_scratch.m_Ap, b, x, m_scratch.m_r);
    m_rNorm = vectors.norm(m_scratch.m_r);
}

bool ConjugateGradients::isSolved() const
{
    const double share = m_report.m_iterations == 0 && m_guessed ? kGuessShare : 1;
    return m_rNorm <= share * m_goal && std::isfinite(m_goal);
}

void ConjugateGradients::checkForEnd()
{
    if (m_rNorm <= m_goal && !m_residualIsTrue)
    {
        m_rNorm = measureTruly();
        m_residualIsTrue = true;
        m_rz = 0;  // restart from here if the recurrence had drifted
    }
    if (isSolved())
        end(SolveStop::converged);
    else if (m_report.m_iterations == m_stop.m_maxIterations)
        end(SolveStop::budget);
}

// False if the system turned out not to be positive definite, or not finite; x is then as before.
bool ConjugateGradients::advance()
{
    const NodeVectors vectors(m_stop.m_threads);
    ConjugateGradientScratch& s = m_scratch;
    const double rz = vectors.dot(s.m_r, s.m_z);
    vectors.turn(m_rz > 0 ? rz / m_rz : 0, s.m_z, s.m_p);
    m_problem.m_A->apply(s.m_p, s.m_Ap);
    const double pAp = vectors.dot(s.m_p, s.m_Ap), step = rz / pAp;
    if (!(rz > 0) || !(pAp > 0) || !std::isfinite(step)) return false;
    vectors.advance(step, s, *m_problem.m_x, s.m_r);
    m_rz = rz;
    m_rNorm = vectors.norm(s.m_r);
    return true;
}

void ConjugateGradients::resume()
{
    if (!advance()) return end(SolveStop::breakdown);
    ++m_report.m_iterations;
    m_residualIsTrue = m_stop.m_tolerance >= kTrustedTolerance && m_report.m_iterations <= kTrustedIterations;
    checkForEnd();
}

void ConjugateGradients::end(SolveStop stop)
{
    if (!m_residualIsTrue) m_rNorm = measureTruly();
    m_report.m_stop = stop;
    const double scale = m_stop.m_steady ? std::max(m_bNorm, m_stop.m_floor) : m_bNorm;
    m_report.m_residual = scale > 0 ? m_rNorm / scale : 0;
    m_over = true;
}

SolveReport solveConjugateGradients(const LinearOperator& A, const LinearOperator& P, const std::vector<Vec3>& b,
                                    const ConjugateGradientStop& stop, ConjugateGradientScratch& scratch,
                                    std::vector<Vec3>& x)
{
    ConjugateGradients solve({&A, &b, &x}, stop, scratch);
    while (solve.needsPreconditioner())
    {
        P.apply(scratch.m_r, scratch.m_z);
        solve.resume();
    }
    return solve.report();
}

}  // namespace bullet_fem
