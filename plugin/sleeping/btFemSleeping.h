// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plugin/sleeping/btFemNeighbours.h"

class btCollisionObject;
class btFemBodyRegistry;
struct btFemEntry;

/// What acts on a body besides its neighbours, for comparison.
using btFemInfluences = std::array<double, 20>;

/// What a body's rest depends on besides its nodes, as it was at the end of the last step, so that a change by the user
/// is noticed. Kept for bodies that sleep or are about to; addresses are compared, never followed.
struct btFemSleep
{
    bool m_asleep = false;    ///< at rest, with zeroed velocities
    bool m_recorded = false;  ///< the members below are those of the last step's end
    btFemInfluences m_influences = {};
    std::uint64_t m_targets = 0;  ///< mark of the targets of nodes and springs
    std::vector<btFemNeighbour> m_neighbours;
    std::uint64_t m_forces = 0;   ///< mark of m_f as the step began
    double m_fastestSquared = 0;  ///< square of the speed of the fastest node in the last step [m2/s2]
};

// Bodies sleep as Bullet's rigid bodies do: after gDeactivationTime below m_sleepingThreshold they want to, and
// Bullet's islands put them to sleep and wake them. The speed compared [m/s] is that of the fastest node, as velocity
// or as way over step, whichever is more. In the order of the step:

/// Before anything of a step is read: wakes bodies whose nodes (m_x, m_v, m_im, m_f, targets), material, influences
/// (gravity, wind, pressure, friction, contact offset, numbers of anchors and joints) or neighbours (see
/// wakeByNeighbours) changed since the last step.
void wakeDisturbedBodies(btFemBodyRegistry& registry);

/// After Bullet's forces were added to m_f: what differs later was written by the user.
void markForces(btFemEntry& entry);

/// During collision detection: wakes a body that a kinematic object moves into. May be called by several threads.
void wakeIfPushed(const btFemEntry& entry, const btCollisionObject& other);

/// Before contacts are searched: bodies that Bullet's islands woke within the step get their forces, and those pairs
/// that Bullet left out because both slept.
void completeWokenBodies(btFemBodyRegistry& registry);

/// After the step, before updateSleep: notes how fast a body that is awake was. May be called by several threads.
void noteSpeed(btFemEntry& entry);

/// After the step: lets bodies at rest ask for sleep, and stills those that islands have put to sleep.
void updateSleep(btFemBodyRegistry& registry);
