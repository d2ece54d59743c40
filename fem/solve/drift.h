// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// The motion of a body from x to x+ in a step: first to y, where the forces of the step act, then onward with the
/// velocities that they cause. Both parts turn movable components exactly (RigidMomentum::advance()). All functions
/// write to the body's scratch.

/// Decides whether the body's components turn exactly in a step [s]: not if it is held, unless it turns far.
void chooseTurning(Body& body, double step);

/// Kick positions y and velocities: x and v after the share 1 - theta of the step without forces; fixed nodes move
/// towards their targets. Without the strain of an external change of velocities, which acts as impulses m_strained /
/// m at y.
void beginDrift(Body& body, const StepSettings& settings);

/// Removes the rigid motions of the components at y from velocities [m/s]; of those that hang on fixed nodes or are led
/// by them, relative to these.
void removeRigidVelocity(const Body& body, std::vector<Vec3>& velocity);

/// Adds factor W x (W x r), with the spin W of the rigid motion, at the nodes of components that move along chords: of
/// those that fixed nodes lead, and all in bodies that are held.
void addInward(const Body& body, double factor, std::vector<Vec3>& change);

/// Computes m_drift, the motion beyond theta h times the end velocities: that to y, and the arcs along which nodes turn
/// from there with the momenta prescribed by the loads.
void noteArcs(Body& body, const StepSettings& settings);

/// After the free motion's solve: moves the nodes also by the share (1 - theta) of an external change of velocities,
/// applied as impulses through the precomputed factor, as contact impulses are. Before, only its rigid part is
/// included.
void driftByOutsideChange(Body& body, const StepSettings& settings);

/// Computes the nodes' mean velocities in the free motion, whose end velocities are in the scratch.
void noteMeanVelocity(Body& body, const StepSettings& settings);

/// Positions x+ and velocities v+ of the state: y and v* after the share theta of the step, plus h push; v+ without
/// `share` of the scratch's m_increment, the unresolved part of the velocities.
void endDrift(Body& body, const StepSettings& settings, double share);

}  // namespace bullet_fem
