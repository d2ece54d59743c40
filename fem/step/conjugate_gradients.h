// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/step/step_types.h"

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

/// What one solve has come to, and what it does next, by the norms and products of its vectors; who owns these asks it
/// again and again, as solveConjugateGradients does.
class ConjugateGradientCourse
{
public:
    ConjugateGradientCourse() = default;

    /// Starts with |b|; `zero`: so is the guess, which then needs no residual.
    ConjugateGradientCourse(const ConjugateGradientStop& stop, double bNorm, bool zero);

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

/// Solves A x = b by preconditioned conjugate gradients [Hestenes & Stiefel 1952], starting from x, which is first
/// scaled to be at least as good as zero. Beyond a few iterations, and for tolerances below 1e-4, the recurrence's
/// residual is checked against the true one before an answer is called converged. At the end m_r of the scratch is
/// b - A x, as the recurrence has it. Never allocates; x stays finite if A, P, b and x are.
SolveReport solveConjugateGradients(const LinearOperator& A, const LinearOperator& P, const std::vector<Vec3>& b,
                                    const ConjugateGradientStop& stop, ConjugateGradientScratch& scratch,
                                    std::vector<Vec3>& x);

/// Sum over nodes of a_i . b_i; the same bits for any number of threads.
double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Threads* threads = nullptr);

}  // namespace bullet_fem
