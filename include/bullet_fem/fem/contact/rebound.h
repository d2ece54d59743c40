// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/contact/contact_problem.h"

namespace bullet_fem
{

/// A connected piece of a body (TetMesh::nodeComponent) as it moves as a whole, between steps: its momenta as those of
/// a rigid body. One with fixed nodes cannot be moved.
BULLETFEM_API RigidProxy wholeMotion(const Body& body, int piece);

/// Adds a rigid motion [m/s], [rad/s] about a centre [m] to the velocities of a piece's nodes, BodyState::m_v.
BULLETFEM_API void addWholeMotion(Body& body, int piece, const Vec3& center, const Vec3& linear, const Vec3& angular);

/// Two rigid proxies that part. What they have closed with is given back as one impulse at one point, so that both
/// momenta are kept.
struct Rebound
{
    int m_first = 0;      ///< index into the rigid proxies of the problem
    int m_second = 0;     ///< likewise
    Vec3 m_point;         ///< where both feel the impulse [m]
    Vec3 m_normal;        ///< unit [-], from the second to the first
    double m_speed = 0;   ///< at which they shall part there [m/s]
    double m_energy = 0;  ///< that their motion may gain by it [J]; below 0 is none
};

/// Changes the velocities of the problem's rigid proxies, and returns the impulse on the first [N s].
BULLETFEM_API Vec3 giveRebound(ContactProblem& problem, const Rebound& rebound);

}  // namespace bullet_fem
