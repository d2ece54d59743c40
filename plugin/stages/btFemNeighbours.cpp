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
#include "bullet_bridge/geometry/shapes/shape_mark.h"
#include "bullet_bridge/rigid/world_objects.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "fem/common/byte_stream.h"
#include "plugin/registry/btFemBodyRegistry.h"

using namespace bullet_fem;

namespace
{

using Neighbours = std::vector<btFemNeighbour>;

// Objects that are farther from a resting body than its contact offset plus this have no contact with it [mean edges].
constexpr double kReach = 0.25;

// Flags of a rigid object that affect its contacts.
constexpr int kContactFlags = btCollisionObject::CF_STATIC_OBJECT | btCollisionObject::CF_KINEMATIC_OBJECT |
                              btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING;

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

// True if the object moves or is not ready to sleep: Bullet's islands do not connect bodies by joints of soft bodies.
bool isMoving(const btCollisionObject& object)
{
    if (object.isStaticOrKinematicObject()) return false;
    const int state = object.getActivationState();
    return state == DISABLE_DEACTIVATION || (state == ACTIVE_TAG && object.getDeactivationTime() <= gDeactivationTime);
}

bool mayCollide(const btSoftBody& soft, const btCollisionObject& object)
{
    const auto& ignored = soft.m_collisionDisabledObjects;
    for (int i = 0; i < ignored.size(); ++i)
        if (ignored[i] == &object) return false;
    return soft.checkCollideWith(&object) && object.checkCollideWith(&soft);
}

// Hashes the weight by which the object may load the body.
void addLoad(std::uint64_t& mark, const btCollisionObject& object)
{
    const btRigidBody* rigid = btRigidBody::upcast(&object);
    if (!rigid || rigid->isStaticOrKinematicObject()) return;
    addToMark(mark, rigid->getInvMass());
    for (int c = 0; c < 3; ++c) addToMark(mark, rigid->getGravity()[c]);
}

// Hash of all properties of an object at `transform` that affect the body. It uses values, not addresses, so that saved
// states can contain it.
std::uint64_t markOf(const btFemBodyRecord& record, const btCollisionObject& object, const btTransform& transform)
{
    std::uint64_t mark = kEmptyMark;
    addToMark(mark, mayCollide(*record.m_softBody, object));
    addToMark(mark, object.getRestitution());
    if (const btSoftBody* soft = btSoftBody::upcast(&object))
    {
        for (const btScalar value : {soft->m_cfg.kDF, soft->m_cfg.kSHR}) addToMark(mark, value);
        addToMark(mark, soft->m_cfg.collisions);
        return mark;
    }
    addToMark(mark, object.getCollisionFlags() & kContactFlags);
    for (const btScalar value : {object.getFriction(), object.getContactStiffness(), object.getContactDamping()})
        addToMark(mark, value);
    addLoad(mark, object);
    const btFemSleepRecord& sleep = record.m_work.m_sleep;
    if (const btCollisionShape* shape = object.getCollisionShape())
        addToMark(mark, markOfShape(*shape, transform, sleep.m_low, sleep.m_high));
    return mark;
}

btFemNeighbour neighbourOf(const btFemBodyRecord& record, const btCollisionObject& object, int id)
{
    btFemNeighbour neighbour = {&object, id, object.getWorldTransform(), false, false};
    neighbour.m_mark = markOf(record, object, neighbour.m_transform);
    return neighbour;
}

void recordBounds(btFemBodyRecord& record)
{
    const FemSoftBody& fem = record.fem();
    const double reach = fem.m_settings.m_contactOffset + kReach * fem.m_body.m_model->mesh().meanEdgeLength();
    Vec3 low = vec3(fem.m_softBody->m_nodes[0].m_x), high = low;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
        for (int c = 0; c < 3; ++c)
        {
            low[c] = std::min(low[c], double(fem.m_softBody->m_nodes[i].m_x[c]));
            high[c] = std::max(high[c], double(fem.m_softBody->m_nodes[i].m_x[c]));
        }
    record.m_work.m_sleep.m_low = low - Vec3{reach, reach, reach};
    record.m_work.m_sleep.m_high = high + Vec3{reach, reach, reach};
}

void recordOverlapping(btFemBodyRecord& record, const btBroadphaseProxy& proxy)
{
    const btCollisionObject& object = objectOf(proxy);
    if (!object.hasContactResponse()) return;
    bool touches = btSoftBody::upcast(&object) != nullptr;  // another soft body may rest on it
    for (int k = 0; k < record.m_reports.m_contacts.size() && !touches; ++k)
        touches = record.m_reports.m_contacts[k].m_other == &object;
    record.m_work.m_sleep.m_neighbours.push_back(neighbourOf(record, object, proxy.m_uniqueId));
    record.m_work.m_sleep.m_neighbours.back().m_touches = touches;
}

void recordHeld(WorldObjects& world, btFemBodyRecord& record)
{
    Neighbours& neighbours = record.m_work.m_sleep.m_neighbours;
    for (const HeldJoint& joint : record.fem().m_joints.m_now)
    {
        if (!joint.m_object || !world.readAndHolds(*record.m_softBody, joint.m_object)) continue;
        if (!findNeighbour(neighbours, *joint.m_object, joint.m_objectId))
            neighbours.push_back(neighbourOf(record, *joint.m_object, joint.m_objectId));
        findNeighbour(neighbours, *joint.m_object, joint.m_objectId)->m_held = true;
    }
}

// Wakes the body if a known neighbour has changed. Objects that move by themselves wake it through their island.
void compare(btFemBodyRecord& record, btFemNeighbour& known)
{
    const btCollisionObject& object = *known.m_object;
    known.m_here = true;
    const bool onItsOwn = !object.isStaticOrKinematicObject() && object.isActive();
    const bool moved = !onItsOwn && !(object.getWorldTransform() == known.m_transform);
    const bool pulls = known.m_held && record.m_work.m_sleep.m_asleep && isMoving(object);
    const bool changed = markOf(record, object, known.m_transform) != known.m_mark;
    if (moved || pulls || changed) record.m_softBody->activate();
}

// True if no island reports the object as new. Soft bodies that were moved by hand are active.
bool restsByItself(const btCollisionObject& object)
{
    return object.isStaticOrKinematicObject() || (!object.isActive() && !btSoftBody::upcast(&object));
}

void compareOverlapping(btFemBodyRecord& record, const btBroadphaseProxy& proxy)
{
    const btCollisionObject& object = objectOf(proxy);
    if (!object.hasContactResponse()) return;
    if (btFemNeighbour* known = findNeighbour(record.m_work.m_sleep.m_neighbours, object, proxy.m_uniqueId))
        compare(record, *known);
    else if (restsByItself(object) && record.m_work.m_sleep.m_asleep)
        record.m_softBody->activate();
}

bool hasRecord(const btFemBodyRecord& record)
{
    return record.m_work.m_sleep.m_recorded;
}

// Wakes soft bodies that a joint connects to this one if it moves: only one of the two has the joint in its record.
void wakeHeldBodies(const btFemBodyRegistry& registry, const btFemBodyRecord& record)
{
    if (!isMoving(*record.m_softBody)) return;
    for (const HeldJoint& joint : record.fem().m_joints.m_now)
        for (const auto& other : registry.records())  // the pointer may dangle: it is only compared
            if (static_cast<const btCollisionObject*>(other->m_softBody) == joint.m_object &&
                other->m_work.m_sleep.m_asleep)
                other->m_softBody->activate();
}

}  // namespace

void visitNeighbours(const btFemBodyRegistry& registry, btFemChoice chosen,
                     void (*visit)(btFemBodyRecord& record, const btBroadphaseProxy& other))
{
    // Takes the broad phase of any body; without one there are no neighbours.
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
    for (const auto& record : registry.records())
        if (record->isStepped() && chosen(*record)) recordBounds(*record);
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
