// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

namespace bullet_fem
{

/// Makes a joint of every attachment of body number `body`: the node follows the point of the other body, and half of a
/// distance between them is taken back a step. Attachments to bodies that are gone are removed. After solveFreeMotion.
JointFlags appendAttachments(int body, const JointScene& scene, ContactProblem& problem);

/// True if one of the nodes is attached to the other body, or carries a point that a node of it is attached to: contact
/// must not push there.
bool isAttached(const FemSoftBody& fem, const std::array<int, 3>& nodes, const FemSoftBody& other);
bool isPointAttached(const FemSoftBody& fem, const SurfacePoint& point, const FemSoftBody& other);

}  // namespace bullet_fem
