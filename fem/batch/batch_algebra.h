// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Sums and products of node vectors of bodies side by side. The results are bitwise equal to those of the step of a
// single body: equal operations in equal order. All arrays are aligned to 64 bytes. Uses the widest vectors that the
// processor has; never allocates.
#pragma once

#include "fem/body/batch_width.h"
#include "fem/body/rigid_momentum.h"
#include "fem/elements/element_blocks.h"
#include "fem/factor/rest_modes.h"

namespace bullet_fem
{

/// One three-dimensional vector per node and body: [node][3][body].
using BodyVectors = double*;
using ConstBodyVectors = const double*;

/// subtract: out = a - b; extrapolate: out = 2 a - b.
void subtract(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
void extrapolate(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes);
/// a += b.
void addVectors(ConstBodyVectors b, BodyVectors a, int nodes);

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

/// b = h (f - alpha m v + sums), where b contains f on entry.
void addForces(const BatchInertia& inertia, const PerBatch& alpha, double step, ConstBodyVectors v, BodyVectors b);
/// b -= share sums.
void subtractSums(const BatchInertia& inertia, double share, BodyVectors b);
/// Ap = factor m p + sums.
void addInertia(const BatchInertia& inertia, const PerBatch& factor, ConstBodyVectors p, BodyVectors Ap);

/// An initial guess x, its right-hand side b, and A x.
struct BatchGuess
{
    int m_nodes;
    ConstBodyVectors m_x, m_b, m_Ax;
};
struct BatchGuessMeasure
{
    PerBatch m_xx, m_bx, m_xAx, m_residual;  ///< x . x, b . x, x . A x, |b - A x|^2
};
BatchGuessMeasure measureGuess(const BatchGuess& guess);

// RigidMomentum for bodies side by side, each a single free connected component.

/// Rigid-body quantities of the bodies.
struct BatchMomenta
{
    PerBatch m_mass;
    PerBatch3 m_center, m_linear, m_angular;
    PerBatch m_inertia[9];  ///< row-major inertia, later its inverse
};

/// Masses and positions of all nodes.
struct BatchMasses
{
    int m_nodes;
    const double* m_mass;  ///< [node][body] [kg]
    ConstBodyVectors m_x;  ///< [m]
};

/// Sets the masses, and m_center to the sum of m x (not yet divided by the mass).
void sumMasses(const BatchMasses& nodes, BatchMomenta& pieces);

/// Sums the momenta prescribed by the loads, p + share (f - alpha p) with p = m v, and the inertia, about m_center,
/// which must be the centre of mass by now. Returns |f|^2, summed in node order.
struct BatchLoads
{
    ConstBodyVectors m_v, m_force;
    PerBatch m_alpha, m_share;
};
PerBatch sumPrescribed(const BatchMasses& nodes, const BatchLoads& loads, BatchMomenta& pieces);

/// RigidMomentum::addInward() and addCentrifugal().
void addInward(const BatchMasses& nodes, const BatchMomenta& pieces, double factor, BodyVectors change);
void addCentrifugal(const BatchMasses& nodes, const BatchMomenta& pieces, double step, BodyVectors b);

/// out = factor a.
void scaleVectors(double factor, ConstBodyVectors a, BodyVectors out, int nodes);

/// Adds share times the impulses [N s] to the prescribed momenta; returns the squared norm of the impulses.
PerBatch addImpulses(const BatchMasses& nodes, ConstBodyVectors impulses, const PerBatch& share, BatchMomenta& pieces);

/// RigidMomentum::removeImpulses() and removeMotion(); return the products with . J and with . dv of the result, summed
/// in the order of the single body's dot().
PerBatch removeImpulses(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors with, BodyVectors J);
PerBatch removeMotion(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors with, BodyVectors dv);

/// v += dv, plus the rigid motion that gives every body its prescribed momentum; m_inertia is the inverse by now.
void addWithMomentum(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors dv, BodyVectors v);

// NodeRotations and the rotations in WarpedPreconditioner for bodies side by side.

/// Averages element rotations to node rotations.
struct BatchNodeRotations
{
    const NodeCorners* m_nodes;
    const float* m_elements;    ///< [element][x, y, z, w][body]
    float* m_out;               ///< [node][9][body], row-major
    unsigned* m_needsFallback;  ///< output, per node: bit b is set if body b needs robustAverage()
};
void averageRotations(const BatchNodeRotations& rotations);

/// Velocities of rigid motions: linear [m/s] and angular [rad/s].
struct BatchMotions
{
    PerBatch3 m_linear, m_angular;
};

/// The factor's vectors of bodies side by side, [position][3][body], and their node rotations.
struct BatchWarp
{
    int m_nodes;
    const int* m_position;    ///< position of each node in the factor
    const float* m_rotation;  ///< [node][9][body]
    float* m_factorVector;
};

/// Factor vector <- R^T in / scale, with `scale` chosen to bring it to order one; returns the scale.
PerBatch rotateIn(const BatchWarp& warp, ConstBodyVectors in);

/// out <- scale R (factor vector).
void rotateOut(const BatchWarp& warp, const PerBatch& scale, BodyVectors out);

/// RestModes::removeImpulses() and replaceMotions() of the factor vectors; `motions` as there, of the one component.
void removeRestImpulses(const RestModes& modes, float* factorVector, BatchMotions& motions);
void replaceRestMotions(const RestModes& modes, const BatchMotions& motions, float* factorVector);

}  // namespace bullet_fem
