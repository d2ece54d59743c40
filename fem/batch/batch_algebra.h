// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Sums and products of node vectors of bodies side by side. Every body gets the bits that the step of a single body
// gives it: the same operations in the same order. All arrays are aligned to 64 bytes. On the widest vectors that the
// processor has; never allocates.
#pragma once

#include "fem/body/batch_width.h"

namespace bullet_fem
{

/// A vector of three a node and body: [node][3][body].
using BodyVectors = double*;
using ConstBodyVectors = const double*;

/// out = a - b, and out = 2 a - b.
void subtract(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
void extrapolate(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
/// a += b; returns |a|^2, a sum over nodes as dot() of single bodies.
PerBatch addAndMeasure(ConstBodyVectors b, BodyVectors a, int nodes);

/// What conjugate gradients do to vectors, in the bodies of `active` (1; others: 0), the others stay.
struct BatchRecurrence
{
    int m_nodes;
    BodyVectors m_x, m_r, m_p;
    ConstBodyVectors m_b, m_Ap;
    PerBatch m_active;
};

/// r = b - Ap; returns |r|^2, as the next ones do.
PerBatch subtractProduct(const BatchRecurrence& v);
/// x *= scale; r = b - scale Ap, or b where scale is 0.
PerBatch scaleGuess(const BatchRecurrence& v, const PerBatch& scale);
/// x += step p, r -= step Ap.
PerBatch advanceAlong(const BatchRecurrence& v, const PerBatch& step);
/// p = z + beta p; z where beta is 0, whatever was in p.
void turnDirection(const BatchRecurrence& v, ConstBodyVectors z, const PerBatch& beta);

/// a = 0 in the bodies of which `kept` is 0.
void clearOthers(const PerBatch& kept, BodyVectors a, int nodes);

/// Masses, and what elements have added up at the nodes.
struct BatchInertia
{
    int m_nodes;
    const double* m_mass;  ///< [node][body] [kg]
    double* m_sums;        ///< [node][2][3][body], two sums a node; taking them leaves zeros
};

/// b = h (f - alpha m v + sums) in place of f; returns |b|^2.
PerBatch addForces(const BatchInertia& inertia, const PerBatch& alpha, double step, ConstBodyVectors v, BodyVectors b);
/// b -= share sums; returns |b|^2.
PerBatch subtractSums(const BatchInertia& inertia, double share, BodyVectors b);
/// Ap = factor m p + sums; returns p . Ap.
PerBatch addInertia(const BatchInertia& inertia, const PerBatch& factor, ConstBodyVectors p, BodyVectors Ap);

/// The same of a guess, of which conjugate gradients ask more.
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
