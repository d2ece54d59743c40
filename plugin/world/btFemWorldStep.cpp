// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/world/btFemWorldStep.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/cluster_joints.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/common/chunks.h"
#include "plugin/stages/btFemBulletContacts.h"
#include "plugin/stages/btFemPrediction.h"
#include "plugin/stages/btFemPublishing.h"
#include "plugin/stages/btFemSleeping.h"

using namespace bullet_fem;

btFemWorldStep::btFemWorldStep(const btFemSolverInfo& info, btFemBodyRegistry& registry, btFemBodySetUp& setUp)
    : m_registry(registry),
      m_setUp(setUp),
      m_threads(info.m_threads),
      m_batchMemory(info.m_batchBodies ? std::make_unique<BatchMemory>() : nullptr),
      m_refactoring(info),
      m_freeMotion(info, m_threads, m_batchMemory.get(),
                   [this](btFemBodyRecord& record, const FreeMotion& motion)
                   { m_refactoring.note(record, motion.m_report.m_iterations); }),
      m_group(info, m_threads, m_batchMemory.get())
{
}

void btFemWorldStep::predict(double step)
{
    wakeDisturbedBodies(m_registry, m_world);
    m_group.beginStep(step);
    m_group.welds().beginStep(step);
    listSweeps(step);
    selectMoving(step);
    runOn(m_due,
          [this, step](btFemBodyRecord& record)
          {
              predictBody(record, bodyStep(record, step));
              m_kinematicSweeps.widenBounds(*record.m_softBody);
              markForces(record);
          });
    for (btFemBodyRecord* record : m_due)
    {
        m_refactoring.renew(m_setUp, *record, bodyStep(*record, step));
        if (m_setUp.readyForSelfContact(*record)) record->fem().m_overlaps.m_soft.push_back(record->m_softBody);
        m_detailChooser.choose(*record, bodyStep(*record, step));
    }
    prepareForCollision(m_registry.records(), step);
    m_rewindSolver.note(m_due.empty() ? nullptr : m_due.front()->m_softBody);
}

// Lists the ways of fast kinematic bodies, and wakes the bodies on them.
void btFemWorldStep::listSweeps(double step)
{
    const auto isPresent = [](const auto& record) { return record->m_membership.m_present && record->isFem(); };
    const auto& records = m_registry.records();
    const auto first = std::find_if(records.begin(), records.end(), isPresent);
    if (first == records.end()) return;
    const btSoftBodyWorldInfo* world = (*first)->m_softBody->m_worldInfo;
    if (!world || !world->m_broadphase) return;
    m_kinematicSweeps.list(*world->m_broadphase, step);
    for (const auto& record : records)
        if (isPresent(record) && m_kinematicSweeps.sweepOver(*record->m_softBody)) record->m_softBody->activate();
}

btFemContactGroup* btFemWorldStep::beginGroup(const btFemIsland& island, double step, bool linksToo)
{
    m_rewindSolver.disable();  // the world's rigid solver solves FEM bodies
    completeWokenBodies(m_registry);
    m_due.clear();
    for (int k = 0; k < island.m_objectCount; ++k)
    {
        const btSoftBody* soft = btSoftBody::upcast(island.m_objects[k]);
        btFemBodyRecord* record = soft ? m_registry.find(soft) : nullptr;
        if (!record || !beginFreeMotion(*record, step)) continue;
        record->m_work.m_stage = btFemStage::free;
        m_due.push_back(record);
    }
    if (m_due.empty()) return nullptr;
    m_freeMotion.solve(m_due, m_group.softPairs());
    m_active.assign(m_due.begin(), m_due.end());
    m_group.collect({m_active, m_registry.records(), step, RigidPhase::solving, &island});
    m_freeMotion.dampTouching(m_group.touching());
    if (m_group.isEmpty()) return nullptr;
    if (!m_group.holdsOnly(island, linksToo))
    {
        for (btFemBodyRecord* record : m_active) record->m_reports.m_step.m_flags |= BT_FEM_SOLVED_AFTER;
        return nullptr;
    }
    for (btFemBodyRecord* record : m_active) record->m_work.m_stage = btFemStage::solved;
    return &m_group;
}

void btFemWorldStep::solve(double step)
{
    completeWokenBodies(m_registry);
    selectUnsolved(step);
    m_freeMotion.solve(m_due, m_group.softPairs());
    if (m_rewindSolver.rewind(m_active, step))
    {
        m_group.collect(
            {m_active, m_registry.records(), step, RigidPhase::solving, nullptr, &m_rewindSolver.islands()});
        m_freeMotion.dampTouching(m_group.touching());
        m_rewindSolver.solve(m_group, step);
    }
    else
    {
        m_group.collect({m_active, m_registry.records(), step, RigidPhase::moved});
        m_freeMotion.dampTouching(m_group.touching());
        m_group.solve();
    }
    finishMotions(step);
}

void btFemWorldStep::publish()
{
    m_active.clear();
    for (const auto& record : m_registry.records())
        if (record->isStepped() && record->m_softBody->isActive())
            m_active.push_back(record.get());
        else
            record->m_work.m_isFinished = false;  // the body may have been stopped after its motion was finished
    for (const btFemBodyRecord* record : m_active) makeRoomForBulletContacts(*record);
    m_world.forget();
    bool onThreads = true;  // true if all world infos refer to one world
    if (!m_active.empty()) m_world.read(*m_active.front()->m_softBody);
    for (const btFemBodyRecord* record : m_active) onThreads = onThreads && m_world.hasRead(*record->m_softBody);
    runTasks(onThreads ? &m_threads : nullptr, static_cast<int>(m_active.size()),
             [&](int k)
             {
                 btFemBodyRecord& record = *m_active[k];
                 if (!record.m_work.m_isFinished)
                 {
                     finishNodes(record);
                     noteSpeed(record);
                 }
                 record.m_work.m_isFinished = false;
                 btFemHelpers::updateEmbeddedSurface(record.m_softBody);
                 writeBulletContacts(record, m_world);
             });
    updateSleep(m_registry, m_world);
}

void btFemWorldStep::split()
{
    m_splitter.split(m_setUp, m_registry.records(), m_threads, m_group.welds().time());
}

// Bodies that are set up and awake.
void btFemWorldStep::selectMoving(double step)
{
    m_due.clear();
    for (const auto& record : m_registry.records())
        if (beginBodyStep(m_setUp, *record, step)) m_due.push_back(record.get());
}

// Bodies whose contact the rigid solver did not solve.
void btFemWorldStep::selectUnsolved(double step)
{
    m_due.clear();
    m_active.clear();
    for (const auto& record : m_registry.records())
    {
        const bool due = beginFreeMotion(*record, step);
        const bool isFree = record->m_membership.m_present && record->m_work.m_stage == btFemStage::free;
        if (due) m_due.push_back(record.get());
        if (due || isFree) m_active.push_back(record.get());
    }
}

void btFemWorldStep::finishMotions(double step)
{
    for (const auto& record : m_registry.records())
        if (record->m_membership.m_present && record->m_work.m_stage == btFemStage::solved)
        {
            readChanges(*record);
            m_active.push_back(record.get());
        }
    m_freeMotion.finish(m_active);
    m_group.giveRebounds(m_active, m_world, step);
    runOn(m_active,
          [](btFemBodyRecord& record)
          {
              writeMotion(record);
              noteSpeed(record);
          });
    for (const auto& record : m_registry.records())
    {
        record->m_work.m_stage = btFemStage::none;
        if (record->isStepped()) showClusterJoints(record->fem());
    }
}

// Adds the changes that callbacks made to the velocities since the body was solved within the rigid solver.
void btFemWorldStep::readChanges(btFemBodyRecord& record)
{
    const std::vector<Vec3>& v = record.fem().m_body.m_state.m_v;
    m_change.assign(v.begin(), v.end());
    readBody(record);
    for (std::size_t i = 0; i < v.size(); ++i) m_change[i] = v[i] - m_change[i];
    addVelocity(record.fem().m_body, m_change);
}
