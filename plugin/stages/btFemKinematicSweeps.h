// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btVector3.h"

class btBroadphaseInterface;
class btSoftBody;

/// The ways of kinematic rigid bodies and of links of multibodies in a step. Bullet's broadphase has the bounds of the
/// former at its end alone, of the latter at its begin, so soft bodies beside these would not meet what passes them
/// within the step.
class btFemKinematicSweeps
{
public:
    /// Lists those that move farther than they are thick in a step [s]. Call when Bullet has set their velocities.
    /// Allocates for more than ever before.
    void list(btBroadphaseInterface& broadphase, double step);

    /// True if one sweeps over the bounds of a soft body without being in them in the broadphase.
    bool sweepOver(const btSoftBody& soft) const;

    /// Widens the bounds of a soft body to the ends of such ways, so that the broadphase pairs it with the bodies.
    void widenBounds(btSoftBody& soft) const;

private:
    struct Sweep
    {
        btVector3 m_low, m_high;  // bounds in the broadphase [m]
        btVector3 m_way;          // from there to the other end of the step's way [m]

        bool passes(const btSoftBody& soft) const;
    };

    std::vector<Sweep> m_sweeps;
    std::vector<btVector3> m_scratch;
};
