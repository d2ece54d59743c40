// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemNeighbours.h"

#include <algorithm>
#include <array>
#include <vector>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/world_objects.h"
#include "plugin/registry/btFemBodyRegistry.h"

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

void recordOverlapping(btFemBodyRecord& record, const btBroadphaseProxy& proxy)
{
    const btCollisionObject& object = objectOf(proxy);
    if (!object.hasContactResponse()) return;
    bool touches = btSoftBody::upcast(&object) != nullptr;  // may be at rest on it, too
    for (int k = 0; k < record.m_reports.m_contacts.size() && !touches; ++k)
        touches = record.m_reports.m_contacts[k].m_other == &object;
    record.m_work.m_sleep.m_neighbours.push_back(
        {&object, proxy.m_uniqueId, object.getWorldTransform(), touches, false});
}

void recordHeld(WorldObjects& world, btFemBodyRecord& record)
{
    Neighbours& neighbours = record.m_work.m_sleep.m_neighbours;
    for (const HeldJoint& joint : record.fem().m_joints.m_now)
    {
        if (!joint.m_object || !world.readAndHolds(*record.m_softBody, joint.m_object)) continue;
        if (btFemNeighbour* known = findNeighbour(neighbours, *joint.m_object, joint.m_objectId))
            known->m_held = true;
        else
            neighbours.push_back({joint.m_object, joint.m_objectId, joint.m_object->getWorldTransform(), false, true});
    }
}

// What moves on its own wakes the body through their island.
void compare(btFemBodyRecord& record, btFemNeighbour& known)
{
    const btCollisionObject& object = *known.m_object;
    known.m_here = true;
    const bool onItsOwn = !object.isStaticOrKinematicObject() && object.isActive();
    const bool moved = !onItsOwn && !(object.getWorldTransform() == known.m_transform);
    const bool pulls = known.m_held && record.m_work.m_sleep.m_asleep && isMoving(object);
    if (moved || pulls) record.m_softBody->activate();
}

void compareOverlapping(btFemBodyRecord& record, const btBroadphaseProxy& proxy)
{
    const btCollisionObject& object = objectOf(proxy);
    if (!object.hasContactResponse()) return;
    if (btFemNeighbour* known = findNeighbour(record.m_work.m_sleep.m_neighbours, object, proxy.m_uniqueId))
        compare(record, *known);
    else if (object.isStaticOrKinematicObject() && record.m_work.m_sleep.m_asleep)
        record.m_softBody->activate();
}

bool hasRecord(const btFemBodyRecord& record)
{
    return record.m_work.m_sleep.m_recorded;
}

// Of two soft bodies that a joint holds, one of which has its record from before.
void wakeHeldBodies(const btFemBodyRegistry& registry, const btFemBodyRecord& record)
{
    if (!isMoving(*record.m_softBody)) return;
    for (const HeldJoint& joint : record.fem().m_joints.m_now)
        for (const auto& other : registry.records())  // the object may be anything, or gone: only compared
            if (static_cast<const btCollisionObject*>(other->m_softBody) == joint.m_object &&
                other->m_work.m_sleep.m_asleep)
                other->m_softBody->activate();
}

}  // namespace

void visitNeighbours(const btFemBodyRegistry& registry, btFemChoice chosen,
                     void (*visit)(btFemBodyRecord& record, const btBroadphaseProxy& other))
{
    // Any body knows the broad phase of all; where none does, there are no neighbours.
    btBroadphaseInterface* broadphase = nullptr;
    for (const auto& record : registry.records())
        if (!broadphase && record->isStepped() && chosen(*record) && record->m_softBody->m_worldInfo)
            broadphase = record->m_softBody->m_worldInfo->m_broadphase;
    if (!broadphase || !broadphase->getOverlappingPairCache()) return;
    const btBroadphasePairArray& pairs = broadphase->getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i)
    {
        const std::array<const btBroadphaseProxy*, 2> proxies = {pairs[i].m_pProxy0, pairs[i].m_pProxy1};
        for (int side = 0; side < 2; ++side)
        {
            const btSoftBody* soft = btSoftBody::upcast(&objectOf(*proxies[side]));
            btFemBodyRecord* record = soft ? registry.find(soft) : nullptr;
            if (record && record->isStepped() && chosen(*record)) visit(*record, *proxies[1 - side]);
        }
    }
}

void recordNeighbours(const btFemBodyRegistry& registry, WorldObjects& world, btFemChoice chosen)
{
    visitNeighbours(registry, chosen, recordOverlapping);
    for (const auto& record : registry.records())
        if (record->isStepped() && chosen(*record)) recordHeld(world, *record);
}

void wakeByNeighbours(const btFemBodyRegistry& registry, WorldObjects& world)
{
    for (const auto& record : registry.records())
        for (btFemNeighbour& neighbour : record->m_work.m_sleep.m_neighbours) neighbour.m_here = false;
    visitNeighbours(registry, hasRecord, compareOverlapping);
    for (const auto& record : registry.records())
    {
        if (!record->isStepped()) continue;
        for (btFemNeighbour& neighbour : record->m_work.m_sleep.m_neighbours)
        {
            if (neighbour.m_held && world.readAndHolds(*record->m_softBody, neighbour.m_object))
                compare(*record, neighbour);
            if ((neighbour.m_touches || neighbour.m_held) && !neighbour.m_here) record->m_softBody->activate();
        }
        wakeHeldBodies(registry, *record);
    }
}

bool holdsMovingObject(WorldObjects& world, const btFemBodyRecord& record)
{
    for (const HeldJoint& joint : record.fem().m_joints.m_now)
        if (joint.m_object && world.readAndHolds(*record.m_softBody, joint.m_object) && isMoving(*joint.m_object))
            return true;
    return false;
}
