// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// How a cluster of a FEM body's nodes moves as a whole: as the rigid body with the momenta of its nodes,
///     v_c = sum m_j v_j / m        w = I^-1 sum m_j d_j x v_j        d_j = x_j - c.
/// An impulse on it acts on the nodes through the transpose, and so as on that rigid body.
class ClusterMotion
{
public:
    /// From the nodes as they are. The cluster's masses count; nodes that were pinned when it was made outweigh the
    /// others. All nodes must be the body's.
    ClusterMotion(const FemSoftBody& fem, const btSoftBody::Cluster& cluster);

    const Vec3& center() const { return m_center; }           ///< c [m]
    const Mat3& rotation() const { return m_rotation; }       ///< from the cluster's first shape
    const Mat3& inverseInertia() const { return m_inverse; }  ///< of the nodes as they are [1/(kg m2)]
    Vec3 linearVelocity(const std::vector<Vec3>& v) const;    ///< for nodal velocities v [m/s]
    Vec3 angularVelocity(const std::vector<Vec3>& v) const;   ///< likewise [rad/s]

    /// End of a joint at the material point that is at `point` [m]: v_c + w x (point - c).
    JointEnd pointEnd(int body, const Vec3& point, ContactProblem& problem) const;

    /// End of a joint that is the cluster's spin w.
    JointEnd spinEnd(int body, ContactProblem& problem) const;

    /// Writes centre, frame, inertia and velocities to Bullet's cluster, whose own update works in single precision
    /// and turns small clusters towards the identity.
    void writeTo(btSoftBody::Cluster& cluster) const;

private:
    double mass(int j) const;  // of the cluster's node j [kg]
    int node(int j) const;
    Vec3 arm(int j) const { return m_fem.m_body.m_state.m_x[node(j)] - m_center; }
    JointEnd newEnd(int body, ContactProblem& problem) const;

    const FemSoftBody& m_fem;
    const btSoftBody::Cluster& m_cluster;
    double m_heaviest = 0;  // mass that counts for a pinned node [kg]
    double m_mass = 0;
    Vec3 m_center;
    Mat3 m_rotation, m_inverse;
};

/// True if all of the cluster's nodes are the body's.
bool isClusterOf(const FemSoftBody& fem, const btSoftBody::Cluster& cluster);

}  // namespace bullet_fem
