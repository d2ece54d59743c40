// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btTransform.h"

class btCollisionObject;
class btFemBodyRegistry;
struct btBroadphaseProxy;
struct btFemEntry;

/// An object beside a body, as it was at the end of a step. Its address is compared, never followed.
struct btFemNeighbour
{
    const btCollisionObject* m_object;
    int m_id;  ///< in the broadphase
    btTransform m_transform;
    bool m_touches;       ///< it has contact points with the body, or is soft
    bool m_held;          ///< an anchor or joint of the body holds it
    bool m_here = false;  ///< scratch: the world still holds it here
};

using btFemChoice = bool (*)(const btFemEntry& entry);

/// Calls a function of (entry, proxy of the other) for all pairs of the chosen bodies that Bullet's broad phase knows:
/// both are in the world.
void visitNeighbours(btFemBodyRegistry& registry, btFemChoice chosen,
                     void (*visit)(btFemEntry& entry, const btBroadphaseProxy& other));

/// Appends to the chosen bodies' empty records all objects that their bounds overlap or their joints hold.
void recordNeighbours(btFemBodyRegistry& registry, btFemChoice chosen);

/// Wakes bodies with a record whose neighbours did what Bullet's islands do not tell: one that touched or was held is
/// gone, one was moved by hand, an immovable one is new; or what a joint holds, in another island, moves.
void wakeByNeighbours(btFemBodyRegistry& registry);

/// True if an anchor or joint of the body holds something that is not ready to rest.
bool holdsMovingObject(btFemBodyRegistry& registry, const btFemEntry& entry);
