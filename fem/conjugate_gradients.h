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
    const Threads* m_threads = nullptr;  ///< who shares the work on long vectors; null: the caller's thread alone
};

/// Solves A x = b by preconditioned conjugate gradients [Hestenes & Stiefel 1952], starting from x, which is first
/// scaled to be at least as good as zero. Beyond a few iterations, and for tolerances below 1e-4, the recurrence's
/// residual is checked against the true one before an answer is called converged. Never allocates; x stays finite if A,
/// P, b and x are.
SolveReport solveConjugateGradients(const LinearOperator& A, const LinearOperator& P, const std::vector<Vec3>& b,
                                    const ConjugateGradientStop& stop, ConjugateGradientScratch& scratch,
                                    std::vector<Vec3>& x);

/// Sum over nodes of a_i . b_i; the same bits for any number of threads.
double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Threads* threads = nullptr);

}  // namespace bullet_fem
