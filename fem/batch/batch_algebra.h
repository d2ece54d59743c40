// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Sums and products of node vectors of bodies side by side. The results are bitwise equal to those of the step of a
// single body: equal operations in equal order. All arrays are aligned to 64 bytes. Uses the widest vectors that the
// processor has; never allocates.
#pragma once

#include "fem/body/batch_width.h"

namespace bullet_fem
{

/// One three-dimensional vector per node and body: [node][3][body].
using BodyVectors = double*;
using ConstBodyVectors = const double*;

/// subtract: out = a - b; extrapolate: out = 2 a - b.
void subtract(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
void extrapolate(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
/// a += b; returns |a|^2, summed over nodes in the order of the single body's dot().
PerBatch addAndMeasure(ConstBodyVectors b, BodyVectors a, int nodes);

/// The vectors of the conjugate gradient recurrence; only bodies with m_active 1 are updated, others (0) keep theirs.
struct BatchRecurrence
{
    int m_nodes;
    BodyVectors m_x, m_r, m_p;
    ConstBodyVectors m_b, m_Ap;
    PerBatch m_active;
};

/// r = b - Ap; returns |r|^2.
PerBatch subtractProduct(const BatchRecurrence& v);
/// x *= scale; r = b - scale Ap, or b where scale is 0. Returns |r|^2.
PerBatch scaleGuess(const BatchRecurrence& v, const PerBatch& scale);
/// x += step p, r -= step Ap. Returns |r|^2.
PerBatch advanceAlong(const BatchRecurrence& v, const PerBatch& step);
/// p = z + beta p; p = z where beta is 0, whatever p contained.
void turnDirection(const BatchRecurrence& v, ConstBodyVectors z, const PerBatch& beta);

/// a = 0 in the bodies with `kept` 0.
void clearOthers(const PerBatch& kept, BodyVectors a, int nodes);

/// Masses, and the elements' sums at the nodes.
struct BatchInertia
{
    int m_nodes;
    const double* m_mass;  ///< [node][body] [kg]
    double* m_sums;        ///< [node][2][3][body], two sums a node; reading them resets them to zero
};

/// b = h (f - alpha m v + sums), where b contains f on entry; returns |b|^2.
PerBatch addForces(const BatchInertia& inertia, const PerBatch& alpha, double step, ConstBodyVectors v, BodyVectors b);
/// b -= share sums; returns |b|^2.
PerBatch subtractSums(const BatchInertia& inertia, double share, BodyVectors b);
/// Ap = factor m p + sums; returns p . Ap.
PerBatch addInertia(const BatchInertia& inertia, const PerBatch& factor, ConstBodyVectors p, BodyVectors Ap);

/// An initial guess x and its right-hand side b; m_Ax receives A x.
struct BatchGuess
{
    ConstBodyVectors m_x, m_b;
    BodyVectors m_Ax;
};
struct BatchGuessMeasure
{
    PerBatch m_xx, m_bx, m_xAx, m_residual;  ///< x . x, b . x, x . A x, |b - A x|^2
};
BatchGuessMeasure measureGuess(const BatchInertia& inertia, const PerBatch& factor, const BatchGuess& guess);

}  // namespace bullet_fem
