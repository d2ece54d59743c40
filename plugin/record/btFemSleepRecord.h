// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "LinearMath/btTransform.h"
#include "bullet_fem/fem/common/vec3.h"

class btCollisionObject;

/// A neighbour of a body at the end of a step. Its address is compared, never dereferenced.
struct btFemNeighbour
{
    const btCollisionObject* m_object;
    int m_id;  ///< broadphase id
    btTransform m_transform;
    bool m_touches;            ///< it is in contact with the body, or soft
    bool m_held;               ///< an anchor or joint of the body holds it
    std::uint64_t m_mark = 0;  ///< hash of its properties that affect the body: shape and material
    bool m_here = false;       ///< scratch: it is still in the world
};

/// Influences on a body other than neighbours, for comparison.
using btFemInfluences = std::array<double, 25>;

/// State, besides the nodes, on which a body's rest depends, at the end of the last step, to detect changes by the
/// user. Kept for bodies that sleep or are about to; addresses are compared, never dereferenced.
struct btFemSleepRecord
{
    bool m_asleep = false;    ///< at rest, with zeroed velocities
    bool m_recorded = false;  ///< the members below are of the end of the last step
    btFemInfluences m_influences = {};
    std::uint64_t m_targets = 0;     ///< hash of the targets of nodes and springs, and of initial stress
    bullet_fem::Vec3 m_low, m_high;  ///< bounds of possible contacts [m]
    std::vector<btFemNeighbour> m_neighbours;
    std::uint64_t m_forces = 0;     ///< hash of m_f at the beginning of the step
    double m_fastestSquared = 0;    ///< square of the speed of the fastest node in the last step [m2/s2]
    bool m_enclosesObject = false;  ///< a rigid object has been found inside the body in this step
};
