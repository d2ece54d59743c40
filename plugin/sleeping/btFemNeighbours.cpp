// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/sleeping/btFemNeighbours.h"

#include <algorithm>
#include <array>
#include <vector>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "plugin/bodies/btFemBodyRegistry.h"

using namespace bullet_fem;

namespace
{

using Neighbours = std::vector<btFemNeighbour>;

const btCollisionObject& objectOf(const btBroadphaseProxy& proxy)
{
    return *static_cast<const btCollisionObject*>(proxy.m_clientObject);
}

btFemNeighbour* findNeighbour(Neighbours& neighbours, const btCollisionObject& object, int id)
{
    for (btFemNeighbour& neighbour : neighbours)
        if (neighbour.m_object == &object && neighbour.m_id == id) return &neighbour;
    return nullptr;
}

// Bullet's islands do not join what joints of soft bodies hold.
bool isMoving(const btCollisionObject& object)
{
    if (object.isStaticOrKinematicObject()) return false;
    const int state = object.getActivationState();
    return state == DISABLE_DEACTIVATION || (state == ACTIVE_TAG && object.getDeactivationTime() <= gDeactivationTime);
}

void recordOverlapping(btFemEntry& entry, const btBroadphaseProxy& proxy)
{
    const btCollisionObject& object = objectOf(proxy);
    if (!object.hasContactResponse()) return;
    bool touches = btSoftBody::upcast(&object) != nullptr;  // may be at rest on it, too
    for (int k = 0; k < entry.m_contacts.size() && !touches; ++k) touches = entry.m_contacts[k].m_other == &object;
    entry.m_sleep.m_neighbours.push_back({&object, proxy.m_uniqueId, object.getWorldTransform(), touches, false});
}

void recordHeld(btFemBodyRegistry& registry, btFemEntry& entry)
{
    Neighbours& neighbours = entry.m_sleep.m_neighbours;
    for (const HeldJoint& joint : entry.m_fem->m_joints.m_now)
    {
        if (!joint.m_object || !registry.worldHolds(*entry.m_softBody, joint.m_object)) continue;
        if (btFemNeighbour* known = findNeighbour(neighbours, *joint.m_object, joint.m_objectId))
            known->m_held = true;
        else
            neighbours.push_back({joint.m_object, joint.m_objectId, joint.m_object->getWorldTransform(), false, true});
    }
}

// What moves on its own wakes the body through their island.
void compare(btFemEntry& entry, btFemNeighbour& known)
{
    const btCollisionObject& object = *known.m_object;
    known.m_here = true;
    const bool onItsOwn = !object.isStaticOrKinematicObject() && object.isActive();
    const bool moved = !onItsOwn && !(object.getWorldTransform() == known.m_transform);
    const bool pulls = known.m_held && entry.m_sleep.m_asleep && isMoving(object);
    if (moved || pulls) entry.m_softBody->activate();
}

void compareOverlapping(btFemEntry& entry, const btBroadphaseProxy& proxy)
{
    const btCollisionObject& object = objectOf(proxy);
    if (!object.hasContactResponse()) return;
    if (btFemNeighbour* known = findNeighbour(entry.m_sleep.m_neighbours, object, proxy.m_uniqueId))
        compare(entry, *known);
    else if (object.isStaticOrKinematicObject() && entry.m_sleep.m_asleep)
        entry.m_softBody->activate();
}

bool hasRecord(const btFemEntry& entry)
{
    return entry.m_sleep.m_recorded;
}

// Of two soft bodies that a joint holds, one of which has its record from before.
void wakeHeldBodies(btFemBodyRegistry& registry, const btFemEntry& entry)
{
    if (!isMoving(*entry.m_softBody)) return;
    for (const HeldJoint& joint : entry.m_fem->m_joints.m_now)
        for (const auto& other : registry.entries())  // the object may be anything, or gone: only compared
            if (static_cast<const btCollisionObject*>(other->m_softBody) == joint.m_object && other->m_sleep.m_asleep)
                other->m_softBody->activate();
}

}  // namespace

void visitNeighbours(btFemBodyRegistry& registry, btFemChoice chosen,
                     void (*visit)(btFemEntry& entry, const btBroadphaseProxy& other))
{
    // Any body knows the broad phase of all; where none does, there are no neighbours.
    btBroadphaseInterface* broadphase = nullptr;
    for (const auto& entry : registry.entries())
        if (!broadphase && entry->isStepped() && chosen(*entry) && entry->m_softBody->m_worldInfo)
            broadphase = entry->m_softBody->m_worldInfo->m_broadphase;
    if (!broadphase || !broadphase->getOverlappingPairCache()) return;
    const btBroadphasePairArray& pairs = broadphase->getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i)
    {
        const std::array<const btBroadphaseProxy*, 2> proxies = {pairs[i].m_pProxy0, pairs[i].m_pProxy1};
        for (int side = 0; side < 2; ++side)
        {
            const btSoftBody* soft = btSoftBody::upcast(&objectOf(*proxies[side]));
            btFemEntry* entry = soft ? registry.find(soft) : nullptr;
            if (entry && entry->isStepped() && chosen(*entry)) visit(*entry, *proxies[1 - side]);
        }
    }
}

void recordNeighbours(btFemBodyRegistry& registry, btFemChoice chosen)
{
    visitNeighbours(registry, chosen, recordOverlapping);
    for (const auto& entry : registry.entries())
        if (entry->isStepped() && chosen(*entry)) recordHeld(registry, *entry);
}

void wakeByNeighbours(btFemBodyRegistry& registry)
{
    for (const auto& entry : registry.entries())
        for (btFemNeighbour& neighbour : entry->m_sleep.m_neighbours) neighbour.m_here = false;
    visitNeighbours(registry, hasRecord, compareOverlapping);
    for (const auto& entry : registry.entries())
    {
        if (!entry->isStepped()) continue;
        for (btFemNeighbour& neighbour : entry->m_sleep.m_neighbours)
        {
            if (neighbour.m_held && registry.worldHolds(*entry->m_softBody, neighbour.m_object))
                compare(*entry, neighbour);
            if ((neighbour.m_touches || neighbour.m_held) && !neighbour.m_here) entry->m_softBody->activate();
        }
        wakeHeldBodies(registry, *entry);
    }
}

bool holdsMovingObject(btFemBodyRegistry& registry, const btFemEntry& entry)
{
    for (const HeldJoint& joint : entry.m_fem->m_joints.m_now)
        if (joint.m_object && registry.worldHolds(*entry.m_softBody, joint.m_object) && isMoving(*joint.m_object))
            return true;
    return false;
}
