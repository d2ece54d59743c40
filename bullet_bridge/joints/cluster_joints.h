// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

namespace bullet_fem
{

/// Linear and angular cluster joints (m_joints) of FEM bodies. Bullet's world solves cluster joints itself, on rigid
/// bodies and on clusters whose impulses do not reach FEM nodes. So from before collision detection until the end of
/// the step, both sides of a joint are on one cluster of its own body, with Bullet's default control: it then has no
/// effect and no pointer that may dangle, and the body may be deleted at any time. Callbacks within a step see joints
/// in that form; joints that they create act in Bullet's way for that step. If a callback removes a body from its world
/// and it is not back by the next step, its joints keep that form and no longer hold anything.

/// Call before collision detection for each FEM body of the world, active or sleeping. Hides the sides of its joints,
/// and removes contact joints, which Bullet creates for bodies with CL_SELF.
void hideClusterJoints(FemSoftBody& fem);

/// Appends Joints for them. A linear joint holds two points of the sides together. An angular joint aligns two axes;
/// its control drives the rotation about them. erp is the share of the error that a step corrects; the softness is (1 -
/// cfm) / cfm for cfm < 1; split has no effect. A control is called when joints are collected, once or twice a step; a
/// speed other than the current one is enforced. Call after solveFreeMotion and hideClusterJoints.
JointFlags appendClusterJoints(int body, const JointScene& scene, ContactProblem& problem);

/// Call when the new state is known for each FEM body of the world. Restores the sides of the joints, and sets frames
/// and velocities of Bullet's clusters.
void showClusterJoints(FemSoftBody& fem);

}  // namespace bullet_fem
