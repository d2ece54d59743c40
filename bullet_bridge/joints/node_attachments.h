// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

namespace bullet_fem
{

/// Appends a joint for each attachment of body `body`: the node follows a point of the other body, and a step corrects
/// half of the distance between them. Removes attachments to bodies that no longer exist. Call after solveFreeMotion.
JointFlags appendAttachments(int body, const JointScene& scene, ContactProblem& problem);

/// True if one of the point's nodes is attached to the other body, or carries a point to which a node of the other body
/// is attached. Contact must not act there.
bool isPointAttached(const FemSoftBody& fem, const SurfacePoint& point, const FemSoftBody& other);

}  // namespace bullet_fem
