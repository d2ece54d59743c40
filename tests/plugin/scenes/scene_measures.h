// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/btFemReports.h"
#include "bullet_fem/fem/common/vec3.h"

class btCollisionObject;
class btRigidBody;
class btSoftBody;
class btFemSoftBodySolver;

namespace bullet_fem
{

/// Linear momentum [kg m/s], angular momentum about the origin [kg m2/s] and kinetic energy [J].
struct Motion
{
    Vec3 m_linear, m_angular;
    double m_energy = 0;

    Motion& operator+=(const Motion& b);
};

/// Sums over the nodes that are not pinned.
Motion motionOf(const btSoftBody& body);
Motion motionOf(const btRigidBody& body);

/// Mass of the nodes that are not pinned [kg].
double massOf(const btSoftBody& body);
Vec3 centerOf(const btSoftBody& body);    ///< centre of mass [m]
Vec3 velocityOf(const btSoftBody& body);  ///< of the centre of mass [m/s]

double lowestHeight(const btSoftBody& body);        ///< smallest z of a node [m]
double fastestNode(const btSoftBody& body);         ///< [m/s]
bool allFinite(const btSoftBody& body);             ///< m_x, m_v, m_q and m_f of each node
std::vector<Vec3> edgesOf(const btSoftBody& body);  ///< vectors from node 0 to each node [m]

/// Maximum difference between two lists of vectors.
double largestDifference(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

/// Bits of positions and velocities of all nodes; of a rigid body its transform and velocities.
std::vector<btScalar> bitsOf(const btSoftBody& body);
std::vector<btScalar> bitsOf(const btRigidBody& body);

/// Sum of the contact impulses on a body in the last step, or only of those by `other` [N s].
Vec3 impulseOn(const btFemSoftBodySolver& solver, const btSoftBody& body, const btCollisionObject* other = nullptr);

}  // namespace bullet_fem
