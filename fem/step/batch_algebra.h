// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Sums and products of node vectors of bodies side by side. Every body gets the bits that the step of a single body
// gives it: the same operations in the same order. All arrays are aligned to 64 bytes. On the widest vectors that the
// processor has; never allocates.
#pragma once

#include "fem/step/batch_width.h"

namespace bullet_fem
{

/// A vector of three a node and body: [node][3][body].
using BodyVectors = double*;
using ConstBodyVectors = const double*;

/// out = a - b, and out = 2 a - b.
void subtractLanes(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
void continueLanes(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
/// a += b; returns |a|^2, a sum over nodes as dot() of single bodies.
PerLane addLanes(ConstBodyVectors b, BodyVectors a, int nodes);

/// What conjugate gradients do to vectors, in the bodies of `active` (1; others: 0), the others stay.
struct LaneRecurrence
{
    int m_nodes;
    BodyVectors m_x, m_r, m_p;
    ConstBodyVectors m_b, m_Ap;
    PerLane m_active;
};

/// r = b - Ap; returns |r|^2, as the next ones do.
PerLane subtractProduct(const LaneRecurrence& v);
/// x *= scale; r = b - scale Ap, or b where scale is 0.
PerLane scaleGuess(const LaneRecurrence& v, const PerLane& scale);
/// x += step p, r -= step Ap.
PerLane advanceAlong(const LaneRecurrence& v, const PerLane& step);
/// p = z + beta p; z where beta is 0, whatever was in p.
void turnDirection(const LaneRecurrence& v, ConstBodyVectors z, const PerLane& beta);

/// a = 0 in the bodies of which `kept` is 0.
void clearOthers(const PerLane& kept, BodyVectors a, int nodes);

/// Masses, and what elements have added up at the nodes.
struct LaneInertia
{
    int m_nodes;
    const double* m_mass;  ///< [node][body] [kg]
    double* m_sums;        ///< [node][2][3][body], two sums a node; taking them leaves zeros
};

/// b = h (f - alpha m v + sums) in place of f; returns |b|^2.
PerLane addForces(const LaneInertia& inertia, const PerLane& alpha, double step, ConstBodyVectors v, BodyVectors b);
/// Ap = factor m p + sums; returns p . Ap.
PerLane addInertia(const LaneInertia& inertia, const PerLane& factor, ConstBodyVectors p, BodyVectors Ap);

/// The same of a guess, of which conjugate gradients ask more.
struct LaneGuess
{
    ConstBodyVectors m_x, m_b;
    BodyVectors m_Ax;
};
struct LaneGuessMeasure
{
    PerLane m_xx, m_bx, m_xAx, m_residual;  ///< x . x, b . x, x . A x, |b - A x|^2
};
LaneGuessMeasure measureGuess(const LaneInertia& inertia, const PerLane& factor, const LaneGuess& guess);

}  // namespace bullet_fem
