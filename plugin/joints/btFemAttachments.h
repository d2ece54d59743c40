// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_fem/btFemAnchors.h"
#include "bullet_fem/btFemSpring.h"

class btTransform;

/// Ties a node to the point of another body (or of the same one) with weights on four of its nodes; returns the
/// attachment's handle, > 0. Throws std::invalid_argument on a bad node or weight.
int attachNode(bullet_fem::FemSoftBody& body, int node, const bullet_fem::FemSoftBody& other,
               const std::array<int, 4>& otherNodes, const std::array<double, 4>& weights);

/// Ties a node of a cloth to such a point of the body. Throws likewise.
int attachCloth(bullet_fem::FemSoftBody& body, const std::array<int, 4>& nodes, const std::array<double, 4>& weights,
                btSoftBody& cloth, int clothNode);

/// Unties either; nothing if the body has no such attachment.
void detachNode(bullet_fem::FemSoftBody& body, int attachment);

/// A group of nodes, as the caller gave it.
struct btFemNodeGroup
{
    const int* m_nodes;
    int m_count;
};

/// Makes the nodes go to the positions, or to their rest positions moved by `fromRest`, within the next step. Throws
/// std::invalid_argument, before anything is changed, on a bad node or position.
void setTargets(bullet_fem::FemSoftBody& body, const btFemNodeGroup& group, const btVector3* positions);
void setTargets(bullet_fem::FemSoftBody& body, const btFemNodeGroup& group, const btTransform& fromRest);

/// Lets them go.
void clearTargets(bullet_fem::FemSoftBody& body, const btFemNodeGroup& group);

/// See btFemSoftBodySolver.
int addSpring(bullet_fem::FemSoftBody& body, const btFemSpring& spring);
void setSpringTarget(bullet_fem::FemSoftBody& body, int spring, const btVector3& target);
void removeSpring(bullet_fem::FemSoftBody& body, int spring);

/// What held the body in the last step.
void writeReports(const bullet_fem::FemSoftBody& body, btAlignedObjectArray<btFemAnchorReport>& reports);
