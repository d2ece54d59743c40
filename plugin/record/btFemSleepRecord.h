// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "LinearMath/btTransform.h"
#include "bullet_fem/fem/common/vec3.h"

class btCollisionObject;

/// An object beside a body, as it was at the end of a step. Its address is compared, never followed.
struct btFemNeighbour
{
    const btCollisionObject* m_object;
    int m_id;  ///< in the broadphase
    btTransform m_transform;
    bool m_touches;            ///< it has contact points with the body, or is soft
    bool m_held;               ///< an anchor or joint of the body holds it
    std::uint64_t m_mark = 0;  ///< of what the body feels of it: shape and material
    bool m_here = false;       ///< scratch: the world still holds it here
};

/// What acts on a body besides its neighbours, for comparison.
using btFemInfluences = std::array<double, 25>;

/// What a body's rest depends on besides its nodes, as it was at the end of the last step, so that a change by the user
/// is noticed. Kept for bodies that sleep or are about to; addresses are compared, never followed.
struct btFemSleepRecord
{
    bool m_asleep = false;    ///< at rest, with zeroed velocities
    bool m_recorded = false;  ///< the members below are those of the last step's end
    btFemInfluences m_influences = {};
    std::uint64_t m_targets = 0;     ///< mark of the targets of nodes and springs, and of initial stress
    bullet_fem::Vec3 m_low, m_high;  ///< bounds of what may touch the body [m]
    std::vector<btFemNeighbour> m_neighbours;
    std::uint64_t m_forces = 0;   ///< mark of m_f as the step began
    double m_fastestSquared = 0;  ///< square of the speed of the fastest node in the last step [m2/s2]
};
