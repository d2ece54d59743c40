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

/// Calls a function of (record, proxy of the other) for all pairs of the chosen bodies that Bullet's broad phase knows:
/// both are in the world.
void visitNeighbours(const btFemBodyRegistry& registry, btFemChoice chosen,
                     void (*visit)(btFemBodyRecord& record, const btBroadphaseProxy& other));

/// Appends to the chosen bodies' empty records all objects that their bounds overlap or their joints hold.
void recordNeighbours(const btFemBodyRegistry& registry, bullet_fem::WorldObjects& world, btFemChoice chosen);

/// Wakes bodies with a record whose neighbours did what Bullet's islands do not tell: one that touched or was held is
/// gone, one was moved by hand or has another shape or material, a rigid one at rest is new; or what a joint holds, in
/// another island, moves.
void wakeByNeighbours(const btFemBodyRegistry& registry, bullet_fem::WorldObjects& world);

/// True if an anchor or joint of the body holds something that is not ready to rest.
bool holdsMovingObject(bullet_fem::WorldObjects& world, const btFemBodyRecord& record);
