// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_fem/btFemAnchors.h"
#include "bullet_fem/btFemSpring.h"

class btTransform;

/// Attaches a node to a point of another body (or of its own) with barycentric weights of four nodes, sum 1. Returns
/// the attachment's handle, > 0. Throws std::invalid_argument on an invalid node or weight.
int attachNode(bullet_fem::FemSoftBody& body, int node, const bullet_fem::FemSoftBody& other,
               const std::array<int, 4>& otherNodes, const std::array<double, 4>& weights);

/// Attaches a node of a cloth to a point of the body with barycentric weights of four nodes, sum 1. Returns the
/// attachment's handle, > 0. Throws std::invalid_argument on an invalid node or weight.
int attachCloth(bullet_fem::FemSoftBody& body, const std::array<int, 4>& nodes, const std::array<double, 4>& weights,
                btSoftBody& cloth, int clothNode);

/// Removes an attachment of either kind, or a weld; no effect if the body has none with this handle.
void detachNode(bullet_fem::FemSoftBody& body, int attachment);

/// A group of nodes as given by the caller.
struct btFemNodeGroup
{
    const int* m_nodes;
    int m_count;
};

/// Sets targets that the nodes reach in the next step: positions [m], or rest positions transformed by `fromRest`.
/// Throws std::invalid_argument, and changes nothing, on an invalid node or position.
void setTargets(bullet_fem::FemSoftBody& body, const btFemNodeGroup& group, const btVector3* positions);
void setTargets(bullet_fem::FemSoftBody& body, const btFemNodeGroup& group, const btTransform& fromRest);

/// Removes the nodes' targets. Throws std::invalid_argument on an invalid node.
void clearTargets(bullet_fem::FemSoftBody& body, const btFemNodeGroup& group);

/// See btFemSoftBodySolver.
int addSpring(bullet_fem::FemSoftBody& body, const btFemSpring& spring);
void setSpringTarget(bullet_fem::FemSoftBody& body, int spring, const btVector3& target);
void removeSpring(bullet_fem::FemSoftBody& body, int spring);

/// Writes one report for each joint of the last step.
void writeReports(const bullet_fem::FemSoftBody& body, btAlignedObjectArray<btFemAnchorReport>& reports);
