// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// Flags of readNodes().
struct NodeReadReport
{
    bool m_restored = false;   ///< a value was not finite or too large: the last valid one was restored
    bool m_badMass = false;    ///< an inverse mass was negative or NaN: the node kept its mass; or infinite: see
                               ///< shareOutMass
    bool m_stalePins = false;  ///< the fixed nodes differ from those of the factor
};

/// Largest ratio (>= 1) between the step [s], the node masses or the material and those that the factor was built for.
/// A larger value means a less accurate compliance of the body in contact.
double factorMismatch(const FemSoftBody& fem, double step);

/// Reads the user's changes of m_x, m_v and m_im since the last writeNodes. x and v are kept in double precision; only
/// components whose value differs from the written one are read. The new position of a pinned node is its target within
/// the step. Nodes without elements stay where they are written. Velocities of the whole body, fixed nodes included,
/// are its new state: those of all nodes, those of a rigid motion, and those that come with new positions. Velocities
/// of some nodes are a blow to these, which strains the body. Never allocates.
NodeReadReport readNodes(FemSoftBody& fem);

/// Takes the pinned nodes of a new body that the user moved from m_q, where the body was made, as led to m_x within the
/// first step, if the free nodes were not moved.
void readLedPins(FemSoftBody& fem);

/// Collects the external loads of the step of `step` [s]: gravity, m_f (in which Bullet's applyForces has put wind and
/// pressure), Bullet's velocity damping kDP per step as a rate, the force of pose matching (matchPose), and the target
/// velocities of pinned nodes. Zeroes m_f. Returns false if a force was dropped because it was not finite or would give
/// the whole body 1e6 m/s within the step.
bool readLoads(FemSoftBody& fem, double step);

/// Writes x to m_x (the former one to m_q) and v to m_v (the former one to m_vn).
void writeNodes(FemSoftBody& fem);

/// Sets the body's world bounds during the next step for the broadphase: positions now and after `step` [s] with
/// present velocities and gravity, enlarged by the contact offset and `margin` [m].
void setSweptBounds(FemSoftBody& fem, double step, double margin);

}  // namespace bullet_fem
