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

// Bodies sleep like Bullet's rigid bodies: after gDeactivationTime below m_sleepingThreshold they want to sleep, and
// Bullet's islands put them to sleep and wake them. The compared speed [m/s] is that of the fastest node, as velocity
// or displacement over step, whichever is larger. In the order of the step:

/// Call before a step reads anything. Wakes bodies whose nodes (m_x, m_v, m_im, m_f, targets), material, influences
/// (gravity, wind, pressure, friction, restitution, hardness, contact offset, numbers of anchors and joints) or
/// neighbours (see wakeByNeighbours) have changed since the last step.
void wakeDisturbedBodies(const btFemBodyRegistry& registry, bullet_fem::WorldObjects& world);

/// Call after Bullet's forces were added to m_f: later differences are the user's.
void markForces(btFemBodyRecord& record);

/// Call during collision detection: wakes a body that a moving kinematic object overlaps. May be called by several
/// threads.
void wakeIfPushed(const btFemBodyRecord& record, const btCollisionObject& other);

/// Call before contact searches. Bodies that Bullet's islands woke within the step get their forces, and the pairs that
/// Bullet omitted because both objects slept.
void completeWokenBodies(const btFemBodyRegistry& registry);

/// Call after the step, before updateSleep: notes the speed of an active body. May be called by several threads.
void noteSpeed(btFemBodyRecord& record);

/// Call after the step: lets resting bodies ask for sleep, and stops those that islands have put to sleep.
void updateSleep(const btFemBodyRegistry& registry, bullet_fem::WorldObjects& world);
