// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// RigidMomentum of bodies side by side, each of one free piece, with the same bits.
#pragma once

#include "fem/batch/batch_algebra.h"
#include "fem/body/rigid_momentum.h"

namespace bullet_fem
{

/// The pieces of some bodies: what the kernels work with.
struct BatchMomenta
{
    PerBatch m_mass;
    PerBatch3 m_center, m_linear, m_angular;
    PerBatch m_inertia[9];  ///< row-major; then its inverse
};

/// Masses and positions of all nodes.
struct BatchMasses
{
    int m_nodes;
    const double* m_mass;  ///< [node][body] [kg]
    ConstBodyVectors m_x;  ///< [m]
};

/// Mass, and the sum of m x in place of the centre.
void sumMasses(const BatchMasses& nodes, BatchMomenta& pieces);

/// Momenta that loads prescribe, and inertia, about the centres that are known by now: p = m v, p + share (f - alpha
/// p). Returns |f|^2, one node after the other.
struct BatchLoads
{
    ConstBodyVectors m_v, m_force;
    PerBatch m_alpha, m_share;
};
PerBatch sumPrescribed(const BatchMasses& nodes, const BatchLoads& loads, BatchMomenta& pieces);

/// w = ofVelocity v - ofTurning h w' x (w' x r) with the angular velocities w' that the prescribed momenta make: see
/// RigidMomentum::addTurning() and ViscousShares.
struct BatchTurning
{
    ConstBodyVectors m_v;
    double m_step, m_ofVelocity, m_ofTurning;
};
void findViscous(const BatchMasses& nodes, const BatchMomenta& pieces, const BatchTurning& turning, BodyVectors w);

/// Adds share times impulses [N s] to the prescribed momenta; returns their squares likewise.
PerBatch addImpulses(const BatchMasses& nodes, ConstBodyVectors impulses, const PerBatch& share, BatchMomenta& pieces);

/// Completes increments of velocities v [m/s]: v + dv gets the rigid motion that addWithMomentum() adds.
void completeIncrements(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors v, BodyVectors dv);

/// v += dv, and the rigid motion that gives every body its prescribed momentum; m_inertia is inverse by now.
void addWithMomentum(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors dv, BodyVectors v);

}  // namespace bullet_fem
