// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btCollisionObject;
class btFemBodyRegistry;
struct btFemBodyRecord;

namespace bullet_fem
{
class WorldObjects;
}

// Bodies sleep as Bullet's rigid bodies do: after gDeactivationTime below m_sleepingThreshold they want to, and
// Bullet's islands put them to sleep and wake them. The speed compared [m/s] is that of the fastest node, as velocity
// or as way over step, whichever is more. In the order of the step:

/// Before anything of a step is read: wakes bodies whose nodes (m_x, m_v, m_im, m_f, targets), material, influences
/// (gravity, wind, pressure, friction, restitution, hardness, contact offset, numbers of anchors and joints) or
/// neighbours (see wakeByNeighbours) changed since the last step.
void wakeDisturbedBodies(const btFemBodyRegistry& registry, bullet_fem::WorldObjects& world);

/// After Bullet's forces were added to m_f: what differs later was written by the user.
void markForces(btFemBodyRecord& record);

/// During collision detection: wakes a body that a kinematic object moves into. May be called by several threads.
void wakeIfPushed(const btFemBodyRecord& record, const btCollisionObject& other);

/// Before contacts are searched: bodies that Bullet's islands woke within the step get their forces, and those pairs
/// that Bullet left out because both slept.
void completeWokenBodies(const btFemBodyRegistry& registry);

/// After the step, before updateSleep: notes how fast a body that is awake was. May be called by several threads.
void noteSpeed(btFemBodyRecord& record);

/// After the step: lets bodies at rest ask for sleep, and stills those that islands have put to sleep.
void updateSleep(const btFemBodyRegistry& registry, bullet_fem::WorldObjects& world);
