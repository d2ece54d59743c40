// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// Bullet's pose matching (btSoftBody::setPose with bframe, m_cfg.kMT in [0, 1]) as an implicit force, added to loads
/// that are complete but for it. Updates m_pose as btSoftBody::predictMotion does.
///
/// Bullet moves every node, having moved it by its velocity, a share kMT of the way to its place in the pose, which is
/// laid over the body by its centre of mass and polar rotation; velocities follow. A spring c = m / h^2 kMT / (1 - kMT)
/// that is taken implicitly does the same to a node on its own:
///
///     m (v+ - v_free) = h c (t - x - h (v+ - v_t))   <=>   x+ = (1 - kMT) (x + h v_free) + kMT (t + h v_t)
///
/// with the target t at the start of the step and the velocity v_t that it moves with. Ours are free of momentum: v_t
/// is the rigid motion that the loads give the body, and t - x has no rigid part. Both are fitted with the node masses,
/// of which pinned nodes have, as in Bullet, 1000 n times the body's: they hold the pose. What hits the body later in
/// the step moves the frame along: of a body that hangs on pinned nodes in one place or on one line, turns it.
void matchPose(FemSoftBody& fem, double step);

}  // namespace bullet_fem
