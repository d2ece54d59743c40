// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Sums and products of node vectors of bodies side by side. Every body gets the bits that the step of a single body
// gives it: the same operations in the same order. All arrays are aligned to 64 bytes. On the widest vectors that the
// processor has; never allocates.
#pragma once

#include "fem/lanes/body_lane.h"

namespace bullet_fem
{

/// A vector of three a node and body: [node][3][body].
using BodyVectors = double*;
using ConstBodyVectors = const double*;

/// Sum over nodes of a . b, as dot() of single bodies.
PerLane dotLanes(ConstBodyVectors a, ConstBodyVectors b, int nodes);

/// Sum over nodes of a . a, one node after the other.
PerLane squareInOrder(ConstBodyVectors a, int nodes);

/// out = a - b, out = 2 a - b, and a += b.
void subtractLanes(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
void continueLanes(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
void addLanes(ConstBodyVectors b, BodyVectors a, int nodes);

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

/// b = f - alpha m v in place of f; masses: [node][body].
void subtractDamping(const double* mass, ConstBodyVectors v, const PerLane& alpha, BodyVectors f, int nodes);
/// b = h (b + sums), with two sums a node, which are zero then: [node][2][3][body].
void addForces(double* sums, double step, BodyVectors b, int nodes);
/// Ap = factor m p + sums, likewise; returns p . Ap.
struct LaneProduct
{
    int m_nodes;
    ConstBodyVectors m_p;
    BodyVectors m_Ap;
};
PerLane addInertia(double* sums, const double* mass, const PerLane& factor, const LaneProduct& v);

}  // namespace bullet_fem
