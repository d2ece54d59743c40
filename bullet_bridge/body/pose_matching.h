// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// Bullet's pose matching (btSoftBody::setPose with bframe, m_cfg.kMT in [0, 1]) as an implicit force, which is added
/// to otherwise complete loads of a step of `step` [s]. Updates m_pose as btSoftBody::predictMotion does.
///
/// Bullet first moves each node by its velocity, then by a share kMT of its distance to its place in the pose, which is
/// aligned with the body by centre of mass and polar rotation; velocities follow. For a single node, an implicit spring
/// c = m / h^2 kMT / (1 - kMT) has this effect:
///
///     m (v+ - v_free) = h c (t - x - h (v+ - v_t))   <=>   x+ = (1 - kMT) (x + h v_free) + kMT (t + h v_t)
///
/// with the target t at the start of the step and its velocity v_t. Here the force is free of momentum: v_t is the
/// rigid motion that the loads give the body, and t - x has no rigid part. Both are fitted with the node masses; a
/// pinned node counts 1000 n times the body's mass, as in Bullet, and so holds the pose. Later loads of the step move
/// the frame along; if all pinned nodes are at one point or on one line, they rotate it.
void matchPose(FemSoftBody& fem, double step);

}  // namespace bullet_fem
