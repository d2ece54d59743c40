// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

namespace bullet_fem
{

/// Linear and angular joints (m_joints) of FEM bodies. Bullet's world solves them by itself, on rigid bodies and on
/// clusters whose impulses nobody hands to the nodes. So from before collision detection until the step's end a joint
/// has both its ends on one cluster of its own body, and Bullet's default control: there it moves nothing, needs no
/// pointer that may dangle, and the body may be deleted at any time. Callbacks within a step see it like that; joints
/// that they make act in Bullet's way once. A body that a callback takes out of its world and that is not back by the
/// next step keeps its joints in that form: they hold nothing any more.

/// Before collision detection, for every FEM body of the world, awake or not: hides the ends of its joints, and removes
/// contact joints, which Bullet makes for bodies with the flag CL_SELF.
void hideClusterJoints(FemSoftBody& fem);

/// Makes Joints of them. A joint holds cluster points together (linear), or axes, leaving the spin about them to the
/// joint's control (angular), with erp as share of the error that is taken back a step and a softness of
/// (1 - cfm) / cfm for cfm < 1; split has no meaning here. A control is asked when the joints are collected, once or
/// twice a step; a speed other than the current one is held. After solveFreeMotion, after hideClusterJoints.
JointFlags appendClusterJoints(int body, const JointScene& scene, ContactProblem& problem);

/// After the new state is known, for every FEM body of the world: gives the joints their ends back, and Bullet's
/// clusters their frames and velocities.
void showClusterJoints(FemSoftBody& fem);

}  // namespace bullet_fem
