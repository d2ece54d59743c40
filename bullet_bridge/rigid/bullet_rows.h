// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletDynamics/ConstraintSolver/btSolverBody.h"
#include "BulletDynamics/ConstraintSolver/btSolverConstraint.h"
#include "bullet_bridge/rigid/row_parts.h"
#include "bullet_fem/fem/contact/contact_problem.h"

namespace bullet_fem
{

/// The constraints of Bullet's rigid solver, after its set-up of an island.
struct BulletConstraints
{
    btAlignedObjectArray<btSolverBody>& m_bodies;
    btConstraintArray& m_joints;
    btConstraintArray& m_contacts;
    btConstraintArray& m_friction;
    btConstraintArray& m_torsions;  ///< rolling and spinning friction
};

/// The side of a row on a solver body. `proxyOf`: per solver body its rigid proxy; -1 for one that does not move.
RowSide sideOf(const BulletConstraints& bullet, int solverBody, const std::vector<int>& proxyOf);

/// Takes the constraints of Bullet's rigid solver into a contact problem, so that they are solved with soft bodies, and
/// writes their impulses back. A row of Bullet is J v + y lambda = rhs / D + J v0 with y = cfm / D, the inverse D of
/// its diagonal, and the velocities v0 before it was solved. Grows with the number of rows, never shrinks.
class BulletRows
{
public:
    /// Appends contacts, joints and torsional friction. `proxyOf`: per solver body its rigid proxy, whose velocity is
    /// that without impulses of these rows; -1 for one that does not move. Rows that are not finite or move nothing are
    /// left out. Clears the velocity changes of the solver bodies: warm starts are part of the problem.
    void append(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem);

    /// Writes the impulses of the solution to Bullet's rows, and removes them from the problem.
    void takeBack(const BulletConstraints& bullet, ContactProblem& problem);

    /// True if a row was left out that Bullet itself could not solve, not finite or with contradictory limits, or if
    /// its cfm is negative, which counts as 0.
    bool anyBad() const { return m_anyBad; }

private:
    struct Torsion
    {
        int m_first = 0, m_count = 0;  // rows of Bullet
        double m_sign = 1;
    };

    void appendContact(const BulletConstraints& bullet, int k, const std::vector<int>& proxyOf,
                       ContactProblem& problem);
    void setFriction(const BulletConstraints& bullet, const btSolverConstraint& row, RowOfContact& contact,
                     RigidContact& touch) const;
    void appendTorsions(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem);
    void appendJoints(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem);

    std::size_t m_firstContact = 0, m_firstTorsion = 0, m_firstJoint = 0, m_firstJacobian = 0;  // in the problem
    std::vector<RowOfContact> m_contacts;
    std::vector<int> m_contactOf;  // per row of Bullet: index in m_contacts; -1: left out
    std::vector<Torsion> m_torsions;
    std::vector<RowOfAxis> m_axes;
    bool m_anyBad = false;
};

}  // namespace bullet_fem
