// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// What reading the nodes found.
struct NodeReadReport
{
    bool m_restored = false;   ///< a value was not finite: the last good one was put back
    bool m_badMass = false;    ///< an inverse mass was negative or NaN: the node kept its mass; or infinite: all
                               ///< the body's mass was shared out by volume
    bool m_stalePins = false;  ///< other nodes are fixed than those that the factor was built for
};

/// By what factor (>= 1) the step [s] or a node's mass differs from those that the factor was built for: the more, the
/// worse contact's picture of the body's compliance.
double factorMismatch(const FemSoftBody& fem, double step);

/// Takes over what the user wrote to m_x, m_v and m_im since the last writeNodes, component by component: x and v are
/// kept in double, and only components whose bits differ from those written are loaded. A pinned node's new position is
/// its target within the step. Nodes without elements stand still where they are written. Never allocates.
NodeReadReport readNodes(FemSoftBody& fem);

/// Collects the external forces of the step: gravity, m_f (to which Bullet's applyForces has added wind and pressure),
/// and Bullet's per-step velocity damping kDP as a rate; the pull of a pose (matchPose); and the target velocities of
/// pinned nodes. Zeroes m_f. Returns false if a force was not finite, or would give the whole body 1e6 m/s within the
/// step (it is dropped).
bool readLoads(FemSoftBody& fem, double step);

/// Writes x to m_x (the old one to m_q), v to m_v (the old one to m_vn).
void writeNodes(FemSoftBody& fem);

/// World bounds of the surface during the next step, for the broadphase: positions now and after `step` [s] with the
/// present velocities and gravity, widened by the contact offset and `margin` [m].
void setSweptBounds(FemSoftBody& fem, double step, double margin);

}  // namespace bullet_fem
