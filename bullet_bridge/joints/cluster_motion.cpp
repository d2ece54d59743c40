// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/cluster_motion.h"

#include <algorithm>
#include <functional>

#include "bullet_fem/bullet_bridge/vectors.h"
#include "fem/common/rotation.h"

namespace bullet_fem
{
namespace
{

constexpr double kPinnedMass = 1e6;     // mass of a pinned node over the sum of the free ones; Bullet's 1e18 leaves no
                                        // digits
constexpr double kPinnedBeyond = 1e17;  // masses above this are pinned [kg]
constexpr double kThinnestInertia = 1e-9;  // regularization of the inertia over its trace, for collinear clusters

}  // namespace

bool isClusterOf(const FemSoftBody& fem, const btSoftBody::Cluster& cluster)
{
    const btAlignedObjectArray<btSoftBody::Node>& nodes = fem.m_softBody->m_nodes;
    const std::less<const void*> before;
    for (int j = 0; j < cluster.m_nodes.size(); ++j)
        if (before(cluster.m_nodes[j], &nodes[0]) || !before(cluster.m_nodes[j], &nodes[0] + nodes.size()))
            return false;
    return cluster.m_nodes.size() > 0 && cluster.m_masses.size() == cluster.m_nodes.size() &&
           cluster.m_framerefs.size() == cluster.m_nodes.size();
}

ClusterMotion::ClusterMotion(const FemSoftBody& fem, const btSoftBody::Cluster& cluster)
    : m_fem(fem), m_cluster(cluster)
{
    const int count = cluster.m_nodes.size();
    double freeMass = 0;
    for (int j = 0; j < count; ++j) freeMass += cluster.m_masses[j] < kPinnedBeyond ? double(cluster.m_masses[j]) : 0;
    m_heaviest = freeMass > 0 ? kPinnedMass * freeMass : 1;
    Vec3 reference;
    for (int j = 0; j < count; ++j)
    {
        m_mass += mass(j);
        m_center += mass(j) * fem.m_body.m_state.m_x[node(j)];
        reference += mass(j) * vec3(cluster.m_framerefs[j]);
    }
    m_center *= 1 / m_mass;
    reference *= 1 / m_mass;
    Mat3 inertia, stretch;
    for (int j = 0; j < count; ++j)
    {
        const Vec3 d = arm(j);
        inertia += mass(j) * (Mat3::diagonal(dot(d, d)) - outer(d, d));
        stretch += mass(j) * outer(d, vec3(cluster.m_framerefs[j]) - reference);
    }
    // Started from the identity, each cluster of an inverted body would need a singular value decomposition.
    m_rotation = polarRotation(stretch, toMatrix(fem.m_body.m_state.m_elementRotation[0]));
    if (trace(inertia) > 0) m_inverse = inverse(inertia + Mat3::diagonal(kThinnestInertia * trace(inertia)));
}

double ClusterMotion::mass(int j) const
{
    const double mass = m_cluster.m_masses[j];
    return mass < kPinnedBeyond ? mass : m_heaviest;
}

int ClusterMotion::node(int j) const
{
    return static_cast<int>(m_cluster.m_nodes[j] - &m_fem.m_softBody->m_nodes[0]);
}

Vec3 ClusterMotion::linearVelocity(const std::vector<Vec3>& v) const
{
    Vec3 momentum;
    for (int j = 0; j < m_cluster.m_nodes.size(); ++j) momentum += mass(j) * v[node(j)];
    return (1 / m_mass) * momentum;
}

Vec3 ClusterMotion::angularVelocity(const std::vector<Vec3>& v) const
{
    Vec3 momentum;
    for (int j = 0; j < m_cluster.m_nodes.size(); ++j) momentum += mass(j) * cross(arm(j), v[node(j)]);
    return m_inverse * momentum;
}

JointEnd ClusterMotion::newEnd(int body, ContactProblem& problem) const
{
    JointEnd end;
    end.m_body = body;
    end.m_first = static_cast<int>(problem.m_handleNodes.size());
    end.m_count = m_cluster.m_nodes.size();
    for (int j = 0; j < end.m_count; ++j) problem.m_handleNodes.push_back(node(j));
    return end;
}

JointEnd ClusterMotion::pointEnd(int body, const Vec3& point, ContactProblem& problem) const
{
    const Mat3 lever = crossMatrix(point - m_center) * m_inverse;
    for (int j = 0; j < m_cluster.m_nodes.size(); ++j)
        problem.m_handleBlocks.push_back(Mat3::diagonal(mass(j) / m_mass) - mass(j) * (lever * crossMatrix(arm(j))));
    return newEnd(body, problem);
}

JointEnd ClusterMotion::spinEnd(int body, ContactProblem& problem) const
{
    for (int j = 0; j < m_cluster.m_nodes.size(); ++j)
        problem.m_handleBlocks.push_back(mass(j) * (m_inverse * crossMatrix(arm(j))));
    return newEnd(body, problem);
}

void ClusterMotion::writeTo(btSoftBody::Cluster& cluster) const
{
    const std::vector<Vec3>& v = m_fem.m_body.m_state.m_v;
    cluster.m_com = bulletVector(m_center);
    cluster.m_framexform = btTransform(bulletMatrix(m_rotation), bulletVector(m_center));
    cluster.m_invwi = cluster.m_framexform.getBasis() * cluster.m_locii * cluster.m_framexform.getBasis().transpose();
    cluster.m_lv = bulletVector(linearVelocity(v));
    cluster.m_av = bulletVector(angularVelocity(v));
    cluster.m_vimpulses[0] = cluster.m_vimpulses[1] = btVector3(0, 0, 0);
    cluster.m_dimpulses[0] = cluster.m_dimpulses[1] = btVector3(0, 0, 0);
    cluster.m_nvimpulses = cluster.m_ndimpulses = 0;
}

}  // namespace bullet_fem
