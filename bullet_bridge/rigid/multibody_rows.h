// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "BulletDynamics/Featherstone/btMultiBodyConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodySolverConstraint.h"
#include "bullet_bridge/rigid/bullet_rows.h"
#include "bullet_bridge/rigid/rigid_proxies.h"

namespace bullet_fem
{

/// The constraints of Bullet's multibody solver, after its set-up of an island without warm start.
struct MultiBodyConstraints
{
    btMultiBodyJacobianData& m_data;
    btMultiBodyConstraintArray& m_joints;
    btMultiBodyConstraintArray& m_contacts;
    btMultiBodyConstraintArray& m_friction;  ///< two rows of each contact
    btMultiBodyConstraintArray& m_rolling;   ///< two rows of a contact
    btMultiBodyConstraintArray& m_spinning;  ///< one row of a contact
};

/// Takes the constraints of Bullet's multibodies into a contact problem, as BulletRows does for rigid bodies. Links in
/// contact become rigid proxies. Rows of joints, motors and limits are known by their generalized Jacobians: up to
/// three of them are the axes of one joint between proxies whose velocity is J q'. The impulses go back to
/// the rows and the multibodies. Grows with the number of rows, never shrinks.
class MultiBodyRows
{
public:
    /// The rows of Bullet, their proxies and the problem that they join.
    struct Scope
    {
        const BulletConstraints& m_rigid;
        const MultiBodyConstraints& m_links;
        const std::vector<int>& m_proxyOf;  ///< per solver body its rigid proxy; -1 for one that does not move
        RigidProxies& m_proxies;
        ContactProblem& m_problem;
    };

    /// Appends contacts, joints and torsional friction, after BulletRows. Rows that are not finite or move nothing are
    /// left out.
    void append(const Scope& scope);

    /// Writes the impulses of the solution to Bullet's rows, and removes them and their proxies from the problem.
    /// Torsional friction becomes impulses on links.
    void takeBack(const Scope& scope);

private:
    using Row = btMultiBodySolverConstraint;

    struct Sides
    {
        RowSide m_a, m_b;
        Vec3 m_atA, m_atB;   // contact points
        double m_lever = 1;  // of torsional friction
    };

    bool sidesOf(const Scope& scope, const Row& row, Sides& sides);
    RowSide linkSide(const Scope& scope, const btMultiBodyLinkCollider* link);
    RowSide between(const Scope& scope, const btMultiBodyLinkCollider& a, const btMultiBodyLinkCollider& b,
                    const Vec3& atA, const Vec3& atB);
    void appendContact(const Scope& scope, int k);
    void setFriction(const Scope& scope, const Row& row, const Sides& sides, RowOfContact& contact,
                     RigidContact& touch) const;
    void appendTorsion(const Scope& scope, int k, const Vec3& spin, double lever);
    int endOfJoint(const Scope& scope, int begin) const;
    void appendJoint(const Scope& scope, int begin, int end);
    void appendAxis(const Scope& scope, int k, int axis, Joint& joint);
    int addCoordinates(const Scope& scope, int begin, int end, bool ofA);

    int m_firstProxy = 0;
    std::size_t m_firstContact = 0, m_firstTorsion = 0, m_firstJoint = 0, m_firstJacobian = 0;  // in the problem
    std::vector<RowOfContact> m_contacts;
    std::vector<RowOfAxis> m_axes;
    std::vector<std::pair<const btMultiBodyLinkCollider*, int>> m_added;  // links with their proxies
    int m_spin = 0, m_roll = 0;               // first rows that may belong to the next contact
    std::vector<btScalar> m_rows;             // scratch: rows of a joint, then their responses
    std::vector<btVector3> m_linkVelocities;  // scratch
};

}  // namespace bullet_fem
