// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// The rigid motion of a cluster of a FEM body's nodes, from the momenta of the nodes:
///     v_c = sum m_j v_j / m,      w = I^-1 sum m_j d_j x v_j,      d_j = x_j - c.
/// An impulse on the cluster acts on the nodes through the transpose, as on that rigid body.
class ClusterMotion
{
public:
    /// Takes the present positions and the cluster's masses; nodes that were pinned when it was made outweigh the
    /// others. All of its nodes must be the body's.
    ClusterMotion(const FemSoftBody& fem, const btSoftBody::Cluster& cluster);

    const Vec3& center() const { return m_center; }           ///< centre of mass c [m]
    const Mat3& rotation() const { return m_rotation; }       ///< from the cluster's reference shape
    const Mat3& inverseInertia() const { return m_inverse; }  ///< at the present positions [1/(kg m2)]
    Vec3 linearVelocity(const std::vector<Vec3>& v) const;    ///< for nodal velocities v [m/s]
    Vec3 angularVelocity(const std::vector<Vec3>& v) const;   ///< for nodal velocities v [rad/s]

    /// Side of a joint at the material point that is at `point` [m]: v_c + w x (point - c).
    JointEnd pointEnd(int body, const Vec3& point, ContactProblem& problem) const;

    /// Side of a joint with the cluster's angular velocity w.
    JointEnd spinEnd(int body, ContactProblem& problem) const;

    /// Writes centre, frame, inertia and velocities to Bullet's cluster. Bullet's own update works in single precision
    /// and rotates small clusters towards the identity.
    void writeTo(btSoftBody::Cluster& cluster) const;

private:
    double mass(int j) const;  // of the cluster's node j [kg]
    int node(int j) const;
    Vec3 arm(int j) const { return m_fem.m_body.m_state.m_x[node(j)] - m_center; }
    JointEnd newEnd(int body, ContactProblem& problem) const;

    const FemSoftBody& m_fem;
    const btSoftBody::Cluster& m_cluster;
    double m_heaviest = 0;  // mass of a pinned node here [kg]
    double m_mass = 0;
    Vec3 m_center;
    Mat3 m_rotation, m_inverse;
};

/// True if all nodes of the cluster belong to the body.
bool isClusterOf(const FemSoftBody& fem, const btSoftBody::Cluster& cluster);

}  // namespace bullet_fem
