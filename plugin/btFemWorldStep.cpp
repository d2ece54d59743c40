// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/btFemWorldStep.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body_arrays.h"
#include "bullet_bridge/face_tree.h"
#include "bullet_bridge/joints/cluster_joints.h"
#include "bullet_bridge/node_exchange.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/common/chunks.h"
#include "plugin/bodies/btFemModelReport.h"
#include "plugin/btFemStopwatch.h"
#include "plugin/contact/btFemTouches.h"

using namespace bullet_fem;

namespace
{

constexpr double kReach = 0.6;  // mean edges around a body: rigid ones go half of one ahead of their contacts

// Ratio of step or mass to the factor's beyond which a body that touches something is factored anew.
constexpr double kRefactorInContact = 1.5;

// What predictMotion of btSoftBody does besides moving nodes, without resetting the links' rest lengths.
void refreshBulletConstants(btSoftBody& soft, double step)
{
    if (soft.m_bUpdateRtCst)
    {
        soft.m_bUpdateRtCst = false;
        soft.updateLinkConstants();
        soft.updateArea();
    }
    soft.m_sst.sdt = static_cast<btScalar>(step);
    soft.m_sst.isdt = 1 / soft.m_sst.sdt;
    soft.m_sst.velmrg = soft.m_sst.sdt * 3;
    soft.m_sst.radmrg = soft.getCollisionShape()->getMargin();
    soft.m_sst.updmrg = soft.m_sst.radmrg * btScalar(0.25);
}

// Wind, pressure and volume conservation. Bullet's wind meets nodes to whose velocities gravity's has just been added.
void applyBulletForces(const FemSoftBody& fem, double step)
{
    btSoftBody& soft = *fem.m_softBody;
    const btSoftBody::Config& cfg = soft.m_cfg;
    const bool inWind = cfg.kLF > 0 || cfg.kDG > 0;
    if (!inWind && cfg.kPR == 0 && !(cfg.kVC > 0)) return;  // Bullet would look at every face all the same
    const btVector3 fall = bulletVector(step * fem.gravity());
    if (!inWind || !isFinite(vec3(fall))) return soft.applyForces();
    soft.addVelocity(fall);  // of nodes that are not pinned
    soft.applyForces();
    for (int i = 0; i < soft.m_nodes.size(); ++i) soft.m_nodes[i].m_v = fem.m_written.m_v[i];  // as has just been read
}

// A body's own step: Bullet scales time by m_cfg.timescale.
double bodyStep(const btFemEntry& entry, double worldStep)
{
    return worldStep * entry.m_softBody->m_cfg.timescale;
}

void clearReport(btFemEntry& entry)
{
    btFemStepReport report;
    report.m_flags = entry.m_report.m_flags | entry.m_setUpFlags | (entry.m_rejected ? BT_FEM_REJECTED : 0);
    report.m_message = entry.m_message.c_str();
    if (entry.m_fem) reportModel(*entry.m_fem->m_body.m_model, report);
    entry.m_report = report;
}

void note(btFemEntry& entry, const SolveReport& solved)
{
    if (solved.m_stop == SolveStop::budget) entry.m_report.m_flags |= BT_FEM_NOT_CONVERGED;
    if (solved.m_stop == SolveStop::breakdown) entry.m_report.m_flags |= BT_FEM_BREAKDOWN;
}

// Normals and speeds, while the nodes are still in the cache.
void finishNodes(btFemEntry& entry)
{
    entry.m_softBody->integrateMotion();
    noteSpeed(entry);
    entry.m_isFinished = true;
}

}  // namespace

bool isUsableStep(double step)
{
    return step >= 1e-6 && step <= 1;
}

StepSettings btFemWorldStep::settingsOf(const btFemEntry& entry) const
{
    StepSettings settings;
    settings.m_step = entry.m_lastStep;
    settings.m_tolerance = m_info.m_tolerance;
    settings.m_maxIterations = m_info.m_maxIterations;
    const btFemDetail detail = detailInUse(entry);
    settings.m_direct = detail == btFemDetail::direct || detail == btFemDetail::oneIteration;
    settings.m_warp =
        detail == btFemDetail::nodalWarp || detail == btFemDetail::oneIteration ? Warp::nodal : Warp::global;
    settings.m_threads = &m_threads;
    settings.m_batchMemory = m_batchMemory.get();
    return settings;
}

void btFemWorldStep::predict(btFemBodyRegistry& registry, double step)
{
    wakeDisturbedBodies(registry);
    m_group.beginStep();
    m_due.clear();
    for (const auto& pointer : registry.entries())
        if (isToBePredicted(registry, *pointer, step)) m_due.push_back(pointer.get());
    m_threads.run(static_cast<int>(m_due.size()), [&](int k) { predictBody(*m_due[k], bodyStep(*m_due[k], step)); });
    for (btFemEntry* entry : m_due)
    {
        const double h = bodyStep(*entry, step);
        renewFactor(registry, *entry, h);
        if (registry.readyForSelfContact(*entry)) entry->m_fem->m_touchingSoft.push_back(entry->m_softBody);
        m_detailChooser.choose(*entry, h);
    }
    for (const auto& entry : registry.entries())  // also of bodies that sleep, or have just become FEM
    {
        if (!entry->m_present || !entry->m_fem) continue;
        hideClusterJoints(*entry->m_fem);
        keepFaceTree(*entry->m_softBody);
        clearBulletContacts(*entry->m_softBody);
    }
}

// Begins a body's step, and sets it up if that is due. False if it is not a FEM body that moves.
bool btFemWorldStep::isToBePredicted(btFemBodyRegistry& registry, btFemEntry& entry, double step)
{
    entry.m_stage = btFemStage::predicted;
    if (entry.m_present) ageTouches(entry);
    if (entry.m_fem)
    {
        entry.m_fem->m_touching.clear();
        entry.m_fem->m_touchingSoft.clear();
    }
    if (!entry.m_present || entry.m_rejected || !entry.m_softBody->isActive()) return false;
    const double h = bodyStep(entry, step);
    if (!isUsableStep(h)) return false;
    if (!entry.m_fem || entry.m_materialChanged || restMatricesChanged(*entry.m_fem)) registry.trySetUp(entry, h);
    if (entry.m_fem) registry.tryChooseSurface(entry);
    return entry.m_fem != nullptr;
}

void btFemWorldStep::updateSurfaces(btFemBodyRegistry& registry)
{
    m_active.clear();
    for (const auto& entry : registry.entries())
        if (entry->isStepped() && entry->m_softBody->isActive())
            m_active.push_back(entry.get());
        else
            entry->m_isFinished = false;  // it may have been stopped since finish()
    for (const btFemEntry* entry : m_active) makeRoomForBulletContacts(*entry);
    registry.forgetWorld();
    const bool onThreads = registry.readWorld(m_active);
    runTasks(onThreads ? &m_threads : nullptr, static_cast<int>(m_active.size()),
             [&](int k)
             {
                 btSoftBody* soft = m_active[k]->m_softBody;
                 if (!m_active[k]->m_isFinished) finishNodes(*m_active[k]);
                 m_active[k]->m_isFinished = false;
                 btFemHelpers::updateEmbeddedSurface(soft);
                 writeBulletContacts(*m_active[k], registry);
             });
}

// What needs the body alone, on any thread.
void btFemWorldStep::predictBody(btFemEntry& entry, double step)
{
    FemSoftBody& fem = *entry.m_fem;
    readBody(entry);
    entry.m_factorMismatch = factorMismatch(fem, step);
    setSweptBounds(fem, step, kReach * fem.m_body.m_model->mesh().meanEdgeLength());
    refreshBulletConstants(*entry.m_softBody, step);
    applyBulletForces(fem, step);
    markForces(entry);
}

// Without contact a stale factor costs iterations only; contact would rest on a wrong picture of the compliance.
void btFemWorldStep::renewFactor(btFemBodyRegistry& registry, btFemEntry& entry, double step)
{
    if (entry.m_contacts.size() == 0 || entry.m_factorMismatch <= kRefactorInContact)
        return m_refactorPolicy.refresh(registry, entry, step);
    registry.tryRefactor(entry, step);
    entry.m_factorAccount.clear();
}

void btFemWorldStep::readBody(btFemEntry& entry)
{
    const NodeReadReport read = readNodes(*entry.m_fem);
    if (read.m_restored) entry.m_report.m_flags |= BT_FEM_RESTORED;
    if (read.m_badMass) entry.m_report.m_flags |= BT_FEM_BAD_MASS;
    if (read.m_stalePins) entry.m_report.m_flags |= BT_FEM_STALE_FACTOR;
}

// True if a body's free motion is still to be solved in this step; false, with a report, if it stands still.
bool btFemWorldStep::isDue(btFemEntry& entry, double worldStep) const
{
    if (!entry.m_present || entry.m_stage != btFemStage::predicted) return false;
    if (!entry.m_fem || entry.m_softBody->isActive()) clearReport(entry);
    if (!entry.m_fem || !entry.m_softBody->isActive() || !arraysAsSetUp(*entry.m_fem)) return false;
    entry.m_lastStep = bodyStep(entry, worldStep);
    if (!isUsableStep(entry.m_lastStep))
    {
        entry.m_report.m_flags |= BT_FEM_BAD_STEP;
        return false;
    }
    return true;
}

// Bodies know nothing of each other here: on any thread, in any order.
void btFemWorldStep::solveFree()
{
    m_dueFems.clear();
    m_dueBodies.clear();
    for (const btFemEntry* entry : m_due)
    {
        m_dueFems.push_back(entry->m_fem.get());
        m_dueBodies.push_back(&entry->m_fem->m_body);
    }
    m_steady.sumImpulses(m_dueFems, m_group.softPairs(), m_threads);
    m_batches.divide(m_dueBodies, m_threads.count(), m_info.m_batchBodies);
    m_motions.resize(m_due.size());
    const std::vector<Range>& batches = m_batches.batches();
    m_threads.run(static_cast<int>(batches.size()), [&](int k) { solveFree(batches[k]); });
}

btFemContactGroup* btFemWorldStep::beginGroup(btFemBodyRegistry& registry, btCollisionObject* const* bodies, int count,
                                              double step)
{
    completeWokenBodies(registry);
    m_due.clear();
    for (int k = 0; k < count; ++k)
    {
        const btSoftBody* soft = btSoftBody::upcast(bodies[k]);
        btFemEntry* entry = soft ? registry.find(soft) : nullptr;
        if (!entry || !isDue(*entry, step)) continue;
        entry->m_stage = btFemStage::free;
        m_due.push_back(entry);
    }
    if (m_due.empty()) return nullptr;
    solveFree();
    m_active.assign(m_due.begin(), m_due.end());
    m_group.collect({m_active, registry, step, RigidPhase::solving});
    if (m_group.isEmpty() || !m_group.holdsOnly(bodies, count)) return nullptr;
    for (btFemEntry* entry : m_active) entry->m_stage = btFemStage::solved;
    return &m_group;
}

void btFemWorldStep::solve(btFemBodyRegistry& registry, double step)
{
    completeWokenBodies(registry);
    m_due.clear();
    m_active.clear();
    for (const auto& entry : registry.entries())
    {
        const bool due = isDue(*entry, step);
        if (due) m_due.push_back(entry.get());
        if (due || (entry->m_present && entry->m_stage == btFemStage::free)) m_active.push_back(entry.get());
    }
    solveFree();
    m_group.collect({m_active, registry, step, RigidPhase::moved});
    m_group.solve();
    for (const auto& entry : registry.entries())
        if (entry->m_present && entry->m_stage == btFemStage::solved)
        {
            readChanges(*entry);
            m_active.push_back(entry.get());
        }
    m_threads.run(static_cast<int>(m_active.size()), [this](int k) { finish(*m_active[k]); });
    for (const auto& entry : registry.entries())
    {
        entry->m_stage = btFemStage::none;
        if (entry->m_present && entry->m_fem) showClusterJoints(*entry->m_fem);
    }
}

// What callbacks wrote since the body was solved within the rigid solver.
void btFemWorldStep::readChanges(btFemEntry& entry)
{
    const std::vector<Vec3>& v = entry.m_fem->m_body.m_state.m_v;
    m_change.assign(v.begin(), v.end());
    readBody(entry);
    for (std::size_t i = 0; i < v.size(); ++i) m_change[i] = v[i] - m_change[i];
    addVelocity(entry.m_fem->m_body, m_change);
}

// Every body of the batch is charged the same time.
void btFemWorldStep::solveFree(const Range& batch)
{
    for (int k = batch.m_begin; k < batch.m_end; ++k) prepareFree(inBatches(k));
    const btFemStopwatch watch;
    const int count = batch.m_end - batch.m_begin;
    for (int k = batch.m_begin; k < batch.m_end; ++k) m_motions[k] = freeMotionOf(inBatches(k));
    solveFreeMotions(m_motions.data() + batch.m_begin, count);
    for (int k = batch.m_begin; k < batch.m_end; ++k) noteFree(inBatches(k), m_motions[k]);
    const auto share = static_cast<btScalar>(watch.milliseconds() / count);
    for (int k = batch.m_begin; k < batch.m_end; ++k) inBatches(k).m_report.m_freeMotionMs = share;
}

void btFemWorldStep::prepareFree(btFemEntry& entry) const
{
    readBody(entry);  // once more: callbacks may have written since predict
    FemSoftBody& fem = *entry.m_fem;
    if (!readLoads(fem, entry.m_lastStep)) entry.m_report.m_flags |= BT_FEM_RESTORED;
    entry.m_staleness = staleness(entry, entry.m_lastStep);
    if (entry.m_staleness > 1) entry.m_report.m_flags |= BT_FEM_STALE_FACTOR;
    entry.m_report.m_detail = detailInUse(entry);
    SteadyBodies::judge(fem, entry.m_lastStep);
}

FreeMotion btFemWorldStep::freeMotionOf(btFemEntry& entry) const
{
    const FemSoftBody& fem = *entry.m_fem;
    FreeMotion motion;
    motion.m_body = &entry.m_fem->m_body;
    motion.m_settings = settingsOf(entry);
    if (fem.m_expected.empty()) return motion;
    motion.m_expected = &fem.m_expected;
    motion.m_expectedFloor = residualFloor(m_info.m_contactTolerance, m_info.m_tolerance);
    return motion;
}

void btFemWorldStep::noteFree(btFemEntry& entry, const FreeMotion& motion) const
{
    const SolveReport& solved = motion.m_report;
    m_detailChooser.judge(entry, solved);
    if (!motion.m_settings.m_direct)
    {
        note(entry, solved);
        m_refactorPolicy.note(entry, solved.m_iterations, entry.m_staleness);
    }
    entry.m_report.m_iterations = solved.m_iterations;
    entry.m_report.m_residual = static_cast<btScalar>(solved.m_residual);
}

void btFemWorldStep::finish(btFemEntry& entry) const
{
    FemSoftBody& fem = *entry.m_fem;
    if (canFinishStep(fem.m_body))
        finishStep(fem.m_body, settingsOf(entry));
    else  // no NaN may reach a node
    {
        entry.m_report.m_flags |= BT_FEM_BREAKDOWN;
        abandonStep(fem.m_body);
    }
    writeNodes(fem);
    finishNodes(entry);
    btFemStepReport& report = entry.m_report;
    const double length = 1e3 * entry.m_lastStep / entry.m_softBody->m_cfg.timescale;
    report.m_tooSlow = entry.m_realTime.isTooSlow(report.m_freeMotionMs + report.m_contactMs, length);
}
