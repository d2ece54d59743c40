// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// RigidMomentum for bodies side by side, each a single free connected component; bitwise equal results.
#pragma once

#include "fem/batch/batch_algebra.h"
#include "fem/body/rigid_momentum.h"

namespace bullet_fem
{

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

/// w = ofVelocity v - ofTurning h w' x (w' x r), with the angular velocities w' of the prescribed momenta: see
/// RigidMomentum::addTurning() and ViscousShares.
struct BatchTurning
{
    ConstBodyVectors m_v;
    double m_step, m_ofVelocity, m_ofTurning;
};
void findViscous(const BatchMasses& nodes, const BatchMomenta& pieces, const BatchTurning& turning, BodyVectors w);

/// Adds share times the impulses [N s] to the prescribed momenta; returns the squared norm of the impulses.
PerBatch addImpulses(const BatchMasses& nodes, ConstBodyVectors impulses, const PerBatch& share, BatchMomenta& pieces);

/// Adds to the increments dv [m/s] the rigid motion that gives v + dv the prescribed momentum.
void completeIncrements(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors v, BodyVectors dv);

/// v += dv, plus the rigid motion that gives every body its prescribed momentum; m_inertia is the inverse by now.
void addWithMomentum(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors dv, BodyVectors v);

}  // namespace bullet_fem
