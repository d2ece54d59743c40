// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/joints/joint_scene.h"

namespace bullet_fem
{

/// Appends a joint for each anchor and deformable anchor of body `body`. At the end of the step the node is at its
/// pivot, up to the share 1 - kAHR of their initial distance. An influence i < 1 gives the joint the softness
/// (1 - i) / i relative to its sides; 0 releases the node. Removes anchors from the soft body if their object left the
/// world. Sets m_battach for anchored nodes and clears it for nodes anchored before. Call after solveFreeMotion.
JointFlags appendAnchors(int body, const JointScene& scene, ContactProblem& problem);

/// Side of a joint at a weighted sum of nodes.
template <std::size_t kCount>
JointEnd pointEnd(int body, const std::array<int, kCount>& nodes, const std::array<double, kCount>& weights,
                  ContactProblem& problem)
{
    JointEnd end;
    end.m_body = body;
    end.m_first = static_cast<int>(problem.m_handleNodes.size());
    for (std::size_t a = 0; a < kCount; ++a)
    {
        if (weights[a] == 0) continue;
        problem.m_handleNodes.push_back(nodes[a]);
        problem.m_handleBlocks.push_back(Mat3::diagonal(weights[a]));
        ++end.m_count;
    }
    return end;
}

/// Side of a joint at one node.
inline JointEnd nodeEnd(int body, int node, ContactProblem& problem)
{
    return pointEnd<1>(body, {node}, {1}, problem);
}

/// Largest correction that a joint of this softness applies in a step of `step` [s] to its error [m]; a rigid joint
/// reaches it fully.
double longestCorrection(const FemSoftBody& fem, double step, double softness = 0);

/// The joint of the last step that `now` continues; null if `now` is new. `nth`: its probable index in `before`.
const HeldJoint* continuedBy(const HeldJoint& now, const std::vector<HeldJoint>& before, std::size_t nth);

}  // namespace bullet_fem
