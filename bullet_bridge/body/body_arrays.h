// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// Repairs pointers after btSoftBody::appendNode has reallocated the nodes. Bullet updates links, faces and anchors
/// only; this updates tetrahedra, parents of render nodes, clusters and deformable anchors that still point to the
/// nodes' former array (at set-up, or at the last call).
void followNodes(FemSoftBody& fem);

/// False if the program has appended or removed nodes or tetrahedra, or moved the nodes' array, since the body was set
/// up. The nodes must not be accessed then.
bool arraysAsSetUp(const FemSoftBody& fem);

/// True if the numbers of nodes and tetrahedra are those of the set-up, and the tetrahedra have unchanged nodes.
bool topologyAsSetUp(const FemSoftBody& fem);

/// topologyAsSetUp() for every step, which checks a part of the tetrahedra each time: see TopologyMarks.
bool topologyInTurnAsSetUp(FemSoftBody& fem);

/// True if all nodes are within 1e6 m of the origin. For others, Bullet's own collision detection reads beyond its
/// arrays.
bool hasUsableNodes(const btSoftBody& body);

}  // namespace bullet_fem
