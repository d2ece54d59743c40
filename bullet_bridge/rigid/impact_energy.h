// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"

class btCollisionObject;

namespace bullet_fem
{

/// A frame that moves with a velocity [m/s] for a time [s]. In it, a moving support does no work.
struct MovingFrame
{
    Vec3 m_velocity;
    double m_time;
};

/// Elastic, kinetic and gravitational energy of a body in a frame [J].
double energyIn(const MovingFrame& frame, const FemSoftBody& fem);

/// Kinetic and gravitational energy of a movable component's whole motion in a frame [J].
double rigidEnergyIn(const MovingFrame& frame, const FemSoftBody& fem, const RigidProxy& whole);

/// Kinetic and gravitational energy of an object that is not soft [J]. Links of multibodies are not counted: energy
/// that goes into them counts as lost.
double energyOf(const btCollisionObject& object);

}  // namespace bullet_fem
