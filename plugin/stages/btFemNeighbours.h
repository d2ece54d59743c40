// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btCollisionObject;
class btFemBodyRegistry;
struct btBroadphaseProxy;
struct btFemBodyRecord;

namespace bullet_fem
{
class WorldObjects;
}

using btFemChoice = bool (*)(const btFemBodyRecord& record);

/// Calls visit(record, proxy of the other object) for all pairs of Bullet's broad phase that contain a chosen body;
/// both objects are in the world.
void visitNeighbours(const btFemBodyRegistry& registry, btFemChoice chosen,
                     void (*visit)(btFemBodyRecord& record, const btBroadphaseProxy& other));

/// Appends all objects that the chosen bodies overlap or are joined to, to their empty lists of neighbours.
void recordNeighbours(const btFemBodyRegistry& registry, bullet_fem::WorldObjects& world, btFemChoice chosen);

/// Wakes sleeping bodies for changes of neighbours that Bullet's islands do not report: one in contact or joined is
/// gone; one was moved by hand or has changed its shape or material; a rigid one at rest is new; or a joined one in
/// another island moves.
void wakeByNeighbours(const btFemBodyRegistry& registry, bullet_fem::WorldObjects& world);

/// True if an anchor or joint connects the body to an object that is not ready to sleep.
bool holdsMovingObject(bullet_fem::WorldObjects& world, const btFemBodyRecord& record);
