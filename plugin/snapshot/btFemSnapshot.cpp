// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/snapshot/btFemSnapshot.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/rigid_dispatch.h"
#include "plugin/snapshot/btFemEnvelope.h"
#include "plugin/snapshot/btFemRecordSnapshot.h"

using namespace bullet_fem;

namespace
{

/// The contents of a saved state.
struct WorldSnapshot
{
    std::vector<btFemRecordSnapshot> m_bodies;  // in the order of the registry, which is that of solving
    SoftPairMemory::Kept m_softPairs;
    RigidHistory::Memory m_rigid;
    double m_time = 0;  // duration of all steps so far [s]
};

template <class Bytes>
void transfer(Bytes& bytes, WorldSnapshot& s)
{
    bytes(s.m_bodies, s.m_softPairs, s.m_rigid, s.m_time);
}

// FEM bodies that are in the world. Other records may belong to deleted bodies, which must not be accessed.
std::vector<btFemBodyRecord*> livingRecords(const btFemSnapshotScope& scope)
{
    std::vector<btFemBodyRecord*> living;
    for (const auto& record : scope.m_registry.records())
    {
        if (record->m_work.m_stage != btFemStage::none)
            reject("a step is being made; call it between steps, not from a tick callback");
        const bool held = !scope.m_worldBodies ||
                          scope.m_worldBodies->findLinearSearch(record->m_softBody) < scope.m_worldBodies->size();
        if (held && record->isFem() && record->m_softBody->getBroadphaseHandle() &&
            btFemBodyRegistry::isAsBuilt(*record))
            living.push_back(record.get());
    }
    return living;
}

WorldIds idsOf(const std::vector<btFemBodyRecord*>& records)
{
    if (records.empty()) return {};
    for (const btFemBodyRecord* known : records)
    {
        btBroadphaseInterface* broadphase =
            known->m_softBody->m_worldInfo ? known->m_softBody->m_worldInfo->m_broadphase : nullptr;
        if (!broadphase) continue;
        WorldIds world(*broadphase);
        if (world.idOf(known->m_softBody) < 0) continue;
        for (const btFemBodyRecord* record : records) world.m_bodies.push_back(&record->fem());
        return world;
    }
    reject(
        "no FEM body has a btSoftBodyWorldInfo with the world's broad phase, by which objects are told apart; set "
        "its m_broadphase");
}

WorldSnapshot read(const unsigned char* data, std::size_t size)
{
    WorldSnapshot snapshot;
    ByteReader bytes = openEnvelope(data, size, btFemContents::state);
    bytes(snapshot);
    if (bytes.left() > 0) reject("it has ", bytes.left(), " bytes too many");
    return snapshot;
}

std::string nameOf(const btFemRecordSnapshot& s)
{
    return message("the FEM body with broad phase id ", s.m_id);
}

// The records of the snapshot's bodies, in its order.
std::vector<btFemBodyRecord*> matched(const WorldSnapshot& snapshot, const std::vector<btFemBodyRecord*>& records,
                                      const WorldIds& world)
{
    std::vector<btFemBodyRecord*> found;
    for (const btFemRecordSnapshot& s : snapshot.m_bodies)
    {
        const FemSoftBody* fem = world.bodyOf(s.m_id);
        const auto isIt = [fem](const btFemBodyRecord* record) { return &record->fem() == fem; };
        const auto at = std::find_if(records.begin(), records.end(), isIt);
        if (at == records.end())
            reject(nameOf(s), " is not in the world, or not FEM yet: prepare() it, or step its world once");
        if (std::find(found.begin(), found.end(), *at) != found.end()) reject(nameOf(s), " is there twice");
        found.push_back(*at);
    }
    return found;
}

/// The present and the former factor of a body.
struct Models
{
    std::shared_ptr<const BodyModel> m_model, m_former;
};

// Finds the factors of a snapshot, or factorizes anew.
Models modelsOf(const btFemRecordSnapshot& s, const btFemBodyRecord& record, btFemBodySetUp& setUp)
{
    Models models;
    models.m_model = record.fem().m_body.m_model;
    if (s.m_materialChanged) return models;  // the next step makes a new one in any case
    const std::shared_ptr<const RestShape> shape = setUp.shapeOf(record, s.m_body.m_shapeMark);
    if (!shape) reject("its rest shape is another than when the state was saved");
    models.m_model = setUp.exactModel(record, shape, factorInputOf(s.m_body));
    if (models.m_model->factorReport().m_path != s.m_body.m_path)
        reject("its factor was of the other kind: m_factorChoice or m_maxFactorMegabytes of the solver is another");
    if (s.m_hasFormerFactor) models.m_former = setUp.exactModel(record, shape, s.m_formerFactor);
    return models;
}

void checkRecord(const btFemRecordSnapshot& s, const btFemBodyRecord& record, const WorldIds& world)
{
    try
    {
        check(s, record, world);
    }
    catch (const std::invalid_argument& error)
    {
        reject(nameOf(s), ": ", error.what());
    }
}

/// A snapshot, its bodies in the world and their factors.
struct CheckedSnapshot
{
    WorldSnapshot m_snapshot;
    std::vector<btFemBodyRecord*> m_bodies;
    WorldIds m_world;
    std::vector<Models> m_models;
};

void restoreChecked(const btFemSnapshotScope& scope, const CheckedSnapshot& checked)
{
    const WorldSnapshot& snapshot = checked.m_snapshot;
    const std::vector<btFemBodyRecord*>& bodies = checked.m_bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        scope.m_setUp.giveFactors(*bodies[b], checked.m_models[b].m_model, checked.m_models[b].m_former);
        restore(snapshot.m_bodies[b], checked.m_world, *bodies[b]);
        clearBulletContacts(*bodies[b]->m_softBody);  // a sleeping body would keep those of another time
    }
    scope.m_registry.putFirst(bodies);
    scope.m_group.softPairs().restore(snapshot.m_softPairs);
    scope.m_group.rigid().history().restore(snapshot.m_rigid);
    scope.m_group.welds().setTime(snapshot.m_time);
    scope.m_group.welds().clearBreaks();
    scope.m_splitter.clearSplits();
}

}  // namespace

void saveSnapshot(const btFemSnapshotScope& scope, std::vector<unsigned char>& buffer)
{
    const std::vector<btFemBodyRecord*> records = livingRecords(scope);
    const WorldIds world = idsOf(records);
    WorldSnapshot snapshot;
    for (const btFemBodyRecord* record : records) snapshot.m_bodies.push_back(snapshotOf(*record, world));
    snapshot.m_softPairs = scope.m_group.softPairs().kept();
    snapshot.m_rigid = scope.m_group.rigid().history().memory();
    snapshot.m_time = scope.m_group.welds().time();
    beginEnvelope(buffer, btFemContents::state);
    ByteWriter bytes(buffer);
    bytes(snapshot);
    closeEnvelope(buffer);
}

std::function<void()> checkedSnapshot(const btFemSnapshotScope& scope, const unsigned char* data, std::size_t size)
{
    WorldSnapshot snapshot = read(data, size);
    const std::vector<btFemBodyRecord*> records = livingRecords(scope);
    const WorldIds world = idsOf(records);
    const std::vector<btFemBodyRecord*> bodies = matched(snapshot, records, world);
    for (std::size_t b = 0; b < bodies.size(); ++b) checkRecord(snapshot.m_bodies[b], *bodies[b], world);
    checkAndDrop(snapshot.m_softPairs, world);
    check(snapshot.m_rigid);
    if (!(snapshot.m_time >= 0 && std::isfinite(snapshot.m_time)))
        reject("the time of all steps is ", snapshot.m_time, " s, below 0 or no number");
    std::vector<Models> models;
    for (std::size_t b = 0; b < bodies.size(); ++b)
        models.push_back(modelsOf(snapshot.m_bodies[b], *bodies[b], scope.m_setUp));

    return [scope, checked = CheckedSnapshot{std::move(snapshot), bodies, world, models}]
    { restoreChecked(scope, checked); };
}
