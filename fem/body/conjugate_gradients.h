// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "fem/body/batch_width.h"
#include "fem/body/convergence_monitor.h"

namespace bullet_fem
{

/// Measures of an initial guess x: x . x and |b - A x|^2.
template <int kBodies>
struct GuessMeasure
{
    PerBody<kBodies> m_xx, m_residual;
};

/// The products b . x and x . A x, for the optimal scaling of the guess.
template <int kBodies>
struct GuessProducts
{
    PerBody<kBodies> m_bx, m_xAx;
};

/// Solves A x = b for one body, or several at once, by preconditioned conjugate gradients [Hestenes & Stiefel 1952],
/// from an initial guess x that is first scaled so that its error is at most that of zero; without `isGuessed`, x must
/// be zero on entry. After a few iterations, and for tolerances below 1e-4, the recurrence's residual is checked
/// against the true one before convergence is accepted. Never allocates; x stays finite if A, P, b and x are.
///
/// System owns the vectors x, b, r, z, p and A p of up to System::kBodies bodies; count() are in use:
///     rightSideSquares()              |b|^2
///     startFromZero()                 r = b
///     measureGuess(), guessProducts() measures and products of x; products refer to the last measureGuess()
///     scaleGuess(scale, isScaled)     x = scale x, r = b - A x where isScaled; r = b - A x elsewhere; returns |r|^2
///     trueResidual(active)            r = b - A x; returns |r|^2
///     precondition(isFirst)           z = P r; returns r . z
///     turnDirection(beta, active)     p = z + beta p
///     applyToDirection()              returns p . A p
///     advance(step, active)           x += step p, r -= step A p; returns |r|^2
/// `active` is 1 for the bodies to update. For other bodies x and r stay; their other vectors are unspecified.
template <class System>
void solveConjugateGradients(System& system, const ConjugateGradientStop* stops, bool isGuessed, SolveReport* reports);

/// A symmetric positive definite operator on node vectors.
class LinearOperator
{
public:
    virtual ~LinearOperator() = default;
    /// out = (operator) in; `in` and `out` are different arrays of equal size.
    virtual void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const = 0;
};

/// The vectors of the recurrence; sized once.
struct ConjugateGradientScratch
{
    explicit ConjugateGradientScratch(int n) : m_r(n), m_z(n), m_p(n), m_Ap(n) {}
    std::vector<Vec3> m_r, m_z, m_p, m_Ap;
};

/// A system given by two operators. After the solve m_scratch.m_r is b - A x, as computed by the recurrence.
struct OperatorSystem
{
    const LinearOperator &m_A, &m_P;
    const std::vector<Vec3>& m_b;
    std::vector<Vec3>& m_x;
    ConjugateGradientScratch& m_scratch;
    /// Threads that share the work on long vectors; null: the calling thread alone.
    const class Threads* m_threads = nullptr;
};

/// Solves the system of one body as described above; m_x is the initial guess.
SolveReport solveConjugateGradients(const OperatorSystem& system, const ConjugateGradientStop& stop,
                                    bool isGuessed = true);

/// Sum over nodes of a_i . b_i; bitwise independent of the number of threads.
double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const class Threads* threads = nullptr);

// Implementation.

namespace conjugate_gradients
{

template <int kBodies>
bool any(const PerBody<kBodies>& flags)
{
    for (double flag : flags.m)
        if (flag > 0) return true;
    return false;
}

template <int kBodies>
PerBody<kBodies> roots(PerBody<kBodies> squares)
{
    for (double& value : squares.m) value = std::sqrt(value);
    return squares;
}

// Keeps guesses that are zero or good enough; scales the others by their optimal factor.
template <class System>
void startFromGuess(System& system, const ConjugateGradientStop* stops, ConvergenceMonitor* monitors)
{
    const auto bNorms = roots(system.rightSideSquares());
    const auto measure = system.measureGuess();
    const auto norms = roots(measure.m_residual);
    PerBody<System::kBodies> scale, isScaled;
    for (int k = 0; k < system.count(); ++k)
    {
        const bool isZero = !(measure.m_xx[k] > 0);
        monitors[k] = {stops[k], bNorms[k], isZero};
        isScaled[k] = !isZero && !monitors[k].noteGuess(norms[k]);
    }
    const auto products = any(isScaled) ? system.guessProducts() : GuessProducts<System::kBodies>();
    for (int k = 0; k < system.count(); ++k)
        scale[k] = isScaled[k] > 0 ? optimalScale(products.m_bx[k], products.m_xAx[k]) : 1;
    const auto scaledNorms = roots(system.scaleGuess(scale, isScaled));
    for (int k = 0; k < system.count(); ++k)
        if (isScaled[k] > 0) monitors[k].noteScaledGuess(scaledNorms[k]);
}

template <class System>
void startFromZero(System& system, const ConjugateGradientStop* stops, ConvergenceMonitor* monitors)
{
    const auto bNorms = roots(system.rightSideSquares());
    for (int k = 0; k < system.count(); ++k) monitors[k] = {stops[k], bNorms[k], true};
    system.startFromZero();
}

// Evaluates true residuals where the monitors request them; converged bodies are over afterwards.
template <class System>
void checkConvergence(System& system, ConvergenceMonitor* monitors)
{
    PerBody<System::kBodies> active;
    for (int k = 0; k < system.count(); ++k) active[k] = monitors[k].wantsTrueResidual();
    if (any(active))
    {
        const auto norms = roots(system.trueResidual(active));
        for (int k = 0; k < system.count(); ++k)
            if (active[k] > 0) monitors[k].noteTrueResidual(norms[k]);
    }
    for (int k = 0; k < system.count(); ++k) active[k] = monitors[k].decide();
    if (!any(active)) return;
    const auto norms = roots(system.trueResidual(active));
    for (int k = 0; k < system.count(); ++k)
        if (active[k] > 0) monitors[k].noteLastResidual(norms[k]);
}

template <class System>
void iterate(System& system, ConvergenceMonitor* monitors, bool isFirst)
{
    PerBody<System::kBodies> active, beta, step;
    for (int k = 0; k < system.count(); ++k) active[k] = !monitors[k].isOver();
    const auto rz = system.precondition(isFirst);
    for (int k = 0; k < system.count(); ++k) beta[k] = monitors[k].beta(rz[k]);
    if (!isFirst) system.turnDirection(beta, active);
    const auto pAp = system.applyToDirection();
    for (int k = 0; k < system.count(); ++k) active[k] = active[k] > 0 && monitors[k].step(rz[k], pAp[k], step[k]);
    if (!any(active)) return;
    const auto norms = roots(system.advance(step, active));
    for (int k = 0; k < system.count(); ++k)
        if (active[k] > 0) monitors[k].noteStep(rz[k], norms[k]);
}

template <class System>
bool isOver(const System& system, const ConvergenceMonitor* monitors)
{
    for (int k = 0; k < system.count(); ++k)
        if (!monitors[k].isOver()) return false;
    return true;
}

}  // namespace conjugate_gradients

template <class System>
void solveConjugateGradients(System& system, const ConjugateGradientStop* stops, bool isGuessed, SolveReport* reports)
{
    using namespace conjugate_gradients;
    ConvergenceMonitor monitors[System::kBodies];
    if (isGuessed)
        startFromGuess(system, stops, monitors);
    else
        startFromZero(system, stops, monitors);
    checkConvergence(system, monitors);
    for (bool isFirst = true; !isOver(system, monitors); isFirst = false)
    {
        iterate(system, monitors, isFirst);
        checkConvergence(system, monitors);
    }
    for (int k = 0; k < system.count(); ++k) reports[k] = monitors[k].report();
}

}  // namespace bullet_fem
