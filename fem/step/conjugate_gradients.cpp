// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

#include "fem/common/chunks.h"

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

    /// x *= scale; r becomes b - A x, or b where nothing is left of x.
    void scaleGuess(double scale, const std::vector<Vec3>& Ax, const std::vector<Vec3>& b, std::vector<Vec3>& x,
                    std::vector<Vec3>& r) const
    {
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

double optimalScale(double bx, double xAx)
{
    const double best = bx / xAx;
    return best > 0 && std::isfinite(best) ? best : 0;
}

ConjugateGradientCourse::ConjugateGradientCourse(const ConjugateGradientStop& stop, double bNorm, bool zero)
    : m_stop(stop),
      m_bNorm(bNorm),
      m_goal(std::max(stop.m_tolerance * std::max(bNorm, stop.m_floor), kNothing)),
      m_rNorm(bNorm),
      m_guessed(!zero || stop.m_steady),
      m_over(false)
{
}

bool ConjugateGradientCourse::noteGuess(double rNorm)
{
    m_rNorm = rNorm;
    return m_rNorm <= kGuessShare * m_goal;
}

bool ConjugateGradientCourse::wantsTrueResidual() const
{
    return m_rNorm <= m_goal && !m_residualIsTrue;
}

void ConjugateGradientCourse::noteTrueResidual(double rNorm)
{
    m_rNorm = rNorm;
    m_residualIsTrue = true;
    m_rz = 0;  // restart from here if the recurrence had drifted
}

bool ConjugateGradientCourse::isSolved() const
{
    const double share = m_report.m_iterations == 0 && m_guessed ? kGuessShare : 1;
    return m_rNorm <= share * m_goal && std::isfinite(m_goal);
}

bool ConjugateGradientCourse::decide()
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

void ConjugateGradientCourse::noteLastResidual(double rNorm)
{
    m_rNorm = rNorm;
    m_residualIsTrue = true;
}

bool ConjugateGradientCourse::step(double rz, double pAp, double& step)
{
    step = rz / pAp;
    if (rz > 0 && pAp > 0 && std::isfinite(step)) return true;
    m_report.m_stop = SolveStop::breakdown;
    m_over = true;
    return false;
}

void ConjugateGradientCourse::noteStep(double rz, double rNorm)
{
    m_rz = rz;
    m_rNorm = rNorm;
    ++m_report.m_iterations;
    m_residualIsTrue = m_stop.m_tolerance >= kTrustedTolerance && m_report.m_iterations <= kTrustedIterations;
}

SolveReport ConjugateGradientCourse::report() const
{
    SolveReport report = m_report;
    const double scale = m_stop.m_steady ? std::max(m_bNorm, m_stop.m_floor) : m_bNorm;
    report.m_residual = scale > 0 ? m_rNorm / scale : 0;
    return report;
}

SolveReport solveConjugateGradients(const LinearOperator& A, const LinearOperator& P, const std::vector<Vec3>& b,
                                    const ConjugateGradientStop& stop, ConjugateGradientScratch& scratch,
                                    std::vector<Vec3>& x)
{
    const NodeVectors vectors(stop.m_threads);
    std::vector<Vec3>&r = scratch.m_r, &z = scratch.m_z, &p = scratch.m_p, &Ap = scratch.m_Ap;
    const auto measureTruly = [&]
    {
        A.apply(x, Ap);
        vectors.residual(b, Ap, r);
        return vectors.norm(r);
    };

    r = b;
    const double bNorm = vectors.norm(b);
    const bool zero = !(vectors.dot(x, x) > 0);
    ConjugateGradientCourse course(stop, bNorm, zero);
    if (!zero && !course.noteGuess(measureTruly()))
    {
        vectors.scaleGuess(optimalScale(vectors.dot(b, x), vectors.dot(x, Ap)), Ap, b, x, r);
        course.noteScaledGuess(vectors.norm(r));
    }
    while (true)
    {
        if (course.wantsTrueResidual()) course.noteTrueResidual(measureTruly());
        if (course.decide()) course.noteLastResidual(measureTruly());
        if (course.isOver()) return course.report();
        P.apply(r, z);
        const double rz = vectors.dot(r, z);
        vectors.turn(course.beta(rz), z, p);
        A.apply(p, Ap);
        double step;
        if (!course.step(rz, vectors.dot(p, Ap), step)) continue;
        vectors.advance(step, scratch, x, r);
        course.noteStep(rz, vectors.norm(r));
    }
}

}  // namespace bullet_fem
