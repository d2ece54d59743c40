// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// appendNode of btSoftBody moves the nodes when their array is full. Links, faces and anchors are pointed to the new
/// places; tetrahedra, the parents of render nodes, clusters and deformable anchors are left with the old ones. This
/// mends what still points to where the nodes of a FEM body were when it was set up, or when this was last called.
void followNodes(FemSoftBody& fem);

/// False once the program has appended or removed nodes or tetrahedra, or moved the nodes' array, since the body was
/// set up: its nodes must not be gone through then.
bool arraysAsSetUp(const FemSoftBody& fem);

/// True if there are as many nodes and tetrahedra, and these still join the nodes that they did.
bool topologyAsSetUp(const FemSoftBody& fem);

/// The same for every step, which looks at a part of the tetrahedra, in turn: see TopologyMarks.
bool topologyInTurnAsSetUp(FemSoftBody& fem);

/// True if all nodes are within 1e6 m of the origin: Bullet's own collision reads beyond its arrays for others.
bool hasUsableNodes(const btSoftBody& body);

}  // namespace bullet_fem
