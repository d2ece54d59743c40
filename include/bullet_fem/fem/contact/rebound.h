// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/contact/contact_problem.h"

namespace bullet_fem
{

/// The motion of a connected component of a body (TetMesh::nodeComponent) as a rigid proxy with equal momenta, between
/// steps. A component with fixed nodes is immovable.
BULLETFEM_API RigidProxy wholeMotion(const Body& body, int component);

/// Adds a rigid motion, linear [m/s] and angular [rad/s] about a centre [m], to the velocities of a component's nodes,
/// BodyState::m_v.
BULLETFEM_API void addWholeMotion(Body& body, int component, const Vec3& center, const Vec3& linear,
                                  const Vec3& angular);

/// The mobility of a rigid proxy at a point [m] along a unit direction [1/kg].
BULLETFEM_API double rigidMobility(const ContactProblem& problem, int rigidProxy, const Vec3& point,
                                   const Vec3& direction);

/// A rebound between two rigid proxies: one impulse at one point, which conserves both momenta, restores a share of
/// their approach speed.
struct Rebound
{
    int m_first = 0;      ///< index into the rigid proxies of the problem
    int m_second = 0;     ///< index into the rigid proxies of the problem
    Vec3 m_point;         ///< point of action of the impulse on both [m]
    Vec3 m_normal;        ///< unit [-], from the second to the first
    double m_speed = 0;   ///< target of their separation speed at the point [m/s]
    double m_energy = 0;  ///< maximum gain of kinetic energy [J]; values below 0 forbid the rebound
};

/// Applies a rebound to the velocities of the problem's rigid proxies, and returns the impulse on the first [N s].
BULLETFEM_API Vec3 giveRebound(ContactProblem& problem, const Rebound& rebound);

}  // namespace bullet_fem
