// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btVector3.h"

class btBroadphaseInterface;
class btSoftBody;

/// The ways of kinematic rigid bodies in a step. Bullet's broadphase has their bounds at its end alone, so bodies
/// beside that would not meet a wall that passes them within the step.
class btFemKinematicSweeps
{
public:
    /// Lists those that move farther than they are thick in a step [s]. Call when Bullet has set their velocities.
    /// Allocates for more than ever before.
    void list(btBroadphaseInterface& broadphase, double step);

    /// True if one sweeps over the bounds of a soft body and has left them at the end of the step.
    bool sweepOver(const btSoftBody& soft) const;

    /// Widens the bounds of a soft body to the ends of such ways, so that the broadphase pairs it with the bodies.
    void widenBounds(btSoftBody& soft) const;

private:
    struct Sweep
    {
        btVector3 m_low, m_high;  // bounds at the end of the step [m]
        btVector3 m_way;          // of the step [m]

        bool passes(const btSoftBody& soft) const;
    };

    std::vector<Sweep> m_sweeps;
};
