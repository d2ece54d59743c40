// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/step_types.h"
#include "bullet_fem/fem/vec3.h"

namespace bullet_fem
{

/// A symmetric positive definite operator on node vectors.
class LinearOperator
{
public:
    virtual ~LinearOperator() = default;
    /// out = (operator) in; the two are different arrays of the same size.
    virtual void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const = 0;
};

/// The vectors of the recurrence; sized once.
struct ConjugateGradientScratch
{
    explicit ConjugateGradientScratch(int n) : m_r(n), m_z(n), m_p(n), m_Ap(n) {}
    std::vector<Vec3> m_r, m_z, m_p, m_Ap;
};

struct ConjugateGradientStop
{
    double m_tolerance = 1e-3;           ///< stop at |r| <= tolerance max(|b|, floor)
    double m_floor = 0;                  ///< in the units of b, >= 0
    int m_maxIterations = 100;           ///< >= 1
    bool m_steady = false;               ///< x is the answer of a step like this one, be it 0, and b may cancel: as it
                                         ///< stands it must be better, and residuals are of max(|b|, floor)
    const Threads* m_threads = nullptr;  ///< who shares the work on long vectors; null: the caller's thread alone
};

/// A x = b; x is the guess, then the answer. What is pointed at must live as long as it is solved.
struct LinearProblem
{
    const LinearOperator* m_A;
    const std::vector<Vec3>* m_b;
    std::vector<Vec3>* m_x;
};

/// Solves A x = b by preconditioned conjugate gradients [Hestenes & Stiefel 1952], starting from x, which is first
/// scaled to be at least as good as zero. Beyond a few iterations, and for tolerances below 1e-4, the recurrence's
/// residual is checked against the true one before an answer is called converged. Never allocates; x stays finite if A,
/// P, b and x are.
///
/// The recurrence stops where it needs the preconditioner, so that several solves can share its application:
///
///     ConjugateGradients solve(problem, stop, scratch);
///     while (solve.needsPreconditioner())
///     {
///         P.apply(scratch.m_r, scratch.m_z);
///         solve.resume();
///     }
class ConjugateGradients
{
public:
    ConjugateGradients(const LinearProblem& problem, const ConjugateGradientStop& stop,
                       ConjugateGradientScratch& scratch);

    /// False once the solve is over, and its report complete; before, m_z <- P m_r of the scratch is to be made.
    bool needsPreconditioner() const { return !m_over; }

    /// One iteration, with the m_z that was made.
    void resume();

    const SolveReport& report() const { return m_report; }

private:
    double measureTruly();
    void start();
    bool isSolved() const;
    bool advance();
    void checkForEnd();
    void end(SolveStop stop);

    LinearProblem m_problem;
    ConjugateGradientStop m_stop;
    ConjugateGradientScratch& m_scratch;
    SolveReport m_report;
    double m_bNorm = 0, m_goal = 0, m_rNorm = 0;
    double m_rz = 0;  // r . z of the iteration before; 0: the next one starts anew
    bool m_guessed = false, m_residualIsTrue = true, m_over = false;
};

/// All of a ConjugateGradients, with a preconditioner of its own.
SolveReport solveConjugateGradients(const LinearOperator& A, const LinearOperator& P, const std::vector<Vec3>& b,
                                    const ConjugateGradientStop& stop, ConjugateGradientScratch& scratch,
                                    std::vector<Vec3>& x);

/// Sum over nodes of a_i . b_i; the same bits for any number of threads.
double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Threads* threads = nullptr);

}  // namespace bullet_fem
