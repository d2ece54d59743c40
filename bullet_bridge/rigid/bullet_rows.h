// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletDynamics/ConstraintSolver/btSolverBody.h"
#include "BulletDynamics/ConstraintSolver/btSolverConstraint.h"
#include "bullet_fem/fem/contact/contact_problem.h"

class btManifoldPoint;

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
    struct Side
    {
        int m_proxy = -1;
        Vec3 m_center, m_linear, m_angular;  // of the solver body: centre, velocities before the solve
    };

    // Orientation of a contact in the problem: its first proxy is Bullet's body A, or else B.
    struct Contact
    {
        int m_row = 0;           // of Bullet
        double m_sign = 1;       // of the problem's impulse as impulse on A
        Vec3 m_first, m_second;  // Bullet's directions of friction
    };

    struct Torsion
    {
        int m_first = 0, m_count = 0;  // rows of Bullet
        double m_sign = 1;
    };

    // An axis of a joint: Bullet's row, with a sign that makes its larger limit the upper one.
    struct Axis
    {
        int m_row = 0, m_joint = 0, m_axis = 0;
        double m_sign = 1;
    };

    Side sideOf(const BulletConstraints& bullet, int solverBody, const std::vector<int>& proxyOf) const;
    void appendContact(const BulletConstraints& bullet, int k, const std::vector<int>& proxyOf,
                       ContactProblem& problem);
    void setFriction(const BulletConstraints& bullet, const btSolverConstraint& row, Contact& contact,
                     RigidContact& touch) const;
    void appendTorsions(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem);
    void appendJoints(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem);
    bool appendAxis(const btSolverConstraint& row, const Side& a, const Side& b, int axis, Joint& joint,
                    ContactProblem& problem);

    std::size_t m_firstContact = 0, m_firstTorsion = 0, m_firstJoint = 0, m_firstJacobian = 0;  // in the problem
    std::vector<Contact> m_contacts;
    std::vector<int> m_contactOf;  // per row of Bullet: index in m_contacts; -1: left out
    std::vector<Torsion> m_torsions;
    std::vector<Axis> m_axes;
    bool m_anyBad = false;
};

}  // namespace bullet_fem
