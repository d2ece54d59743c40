// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

namespace bullet_fem
{

/// Makes a joint of every anchor and deformable anchor of body number `body`. The node ends the step on its pivot, up
/// to the share 1 - kAHR of a distance that was there as it began. An influence i < 1 makes the joint as soft as
/// (1 - i) / i times what it joins; 0 lets the node go. Anchors whose object left the world are removed from the
/// soft body; m_battach says of every node that was ever anchored whether it is. After solveFreeMotion.
JointFlags appendAnchors(int body, const JointScene& scene, ContactProblem& problem);

/// End of a joint at one node.
JointEnd nodeEnd(int body, int node, ContactProblem& problem);

/// Largest way that a joint of this softness is asked to go in a step [s] to correct its error [m]: a rigid one goes it
/// all.
double longestCorrection(const FemSoftBody& fem, double step, double softness = 0);

/// The joint of the last step that `now` goes on with; null if it is new. `nth`: where it probably is.
const HeldJoint* continuedBy(const HeldJoint& now, const std::vector<HeldJoint>& before, std::size_t nth);

}  // namespace bullet_fem
