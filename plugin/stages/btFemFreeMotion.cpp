// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemFreeMotion.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_arrays.h"
#include "bullet_bridge/body/node_exchange.h"
#include "bullet_fem/fem/contact/contact_solver.h"
#include "fem/common/bounds.h"
#include "plugin/record/btFemModelReport.h"
#include "plugin/record/btFemStopwatch.h"

using namespace bullet_fem;

namespace
{

// Residual tolerance of bodies of low interest [-]. In a beam that swings by its own length and bends by more than 90
// degrees, smaller residuals moved the tip within .1 % of the full solution's path; the error grows to 2 mm a step in a
// 4 m beam at residuals of .6. A fixed single iteration, whatever its residual, would make stiff bodies gain energy
// without bound (CoarseDetail).
constexpr double kCoarseTolerance = 0.05;

// Least numerical damping of bodies with joints [-]. In second-order steps, undamped vibrations of bodies that hang on
// each other gain energy from their swing. From .02 on chains of four bars of .3 and 1 MPa have no more than at their
// start for 30 s (TiedBars).
constexpr double kJointDamping = 0.05;

void clearReport(btFemBodyRecord& record)
{
    int& setUp = record.m_model.m_flags;
    setUp &= ~BT_FEM_TOO_SOFT;
    if (record.isFem() && record.m_model.m_tooSoft.look(record.fem())) setUp |= BT_FEM_TOO_SOFT;
    btFemStepReport report;
    report.m_flags = record.m_reports.m_step.m_flags | setUp | (record.m_model.m_rejected ? BT_FEM_REJECTED : 0);
    report.m_message = record.m_model.m_message.c_str();
    if (record.isFem()) reportModel(*record.fem().m_body.m_model, report);
    record.m_reports.m_step = report;
}

// True if the body had joints in the last step, or has anchors or joints now.
bool hasJoints(const btFemBodyRecord& record)
{
    return record.m_reports.m_anchors.size() > 0 || record.m_softBody->m_anchors.size() > 0 ||
           record.m_softBody->m_joints.size() > 0;
}

}  // namespace

bool beginFreeMotion(btFemBodyRecord& record, double worldStep)
{
    if (!record.m_membership.m_present || record.m_work.m_stage != btFemStage::predicted) return false;
    const bool wasDeep = record.isFem() && (stateFlags(record) & BT_FEM_PENETRATING) != 0;
    if (!record.isFem() || record.m_softBody->isActive()) clearReport(record);
    if (!record.isFem() || !record.m_softBody->isActive() || !arraysAsSetUp(record.fem())) return false;
    // Full numerical damping while penetrating: a body that is pushed out must not swing back.
    record.fem().m_body.m_loads.m_leastDamping = wasDeep ? 1 : 0;
    record.fem().m_body.m_loads.m_isHeld = record.fem().m_body.m_loads.m_isInContact = wasDeep;
    record.m_work.m_lastStep = bodyStep(record, worldStep);
    if (!isUsableStep(record.m_work.m_lastStep))
    {
        record.m_reports.m_step.m_flags |= BT_FEM_BAD_STEP;
        return false;
    }
    return true;
}

StepSettings btFemFreeMotion::settingsOf(const btFemBodyRecord& record) const
{
    StepSettings settings;
    settings.m_step = record.m_work.m_lastStep;
    settings.m_tolerance = m_info.m_tolerance;
    settings.m_maxIterations = m_info.m_maxIterations;
    settings.m_numericalDamping = m_info.m_numericalDamping;
    const btFemDetail detail = detailInUse(record);
    if (detail == btFemDetail::direct || detail == btFemDetail::oneIteration)
        settings.m_tolerance = std::max(settings.m_tolerance, kCoarseTolerance / record.m_work.m_staleness);
    settings.m_warp =
        detail == btFemDetail::nodalWarp || detail == btFemDetail::oneIteration ? Warp::nodal : Warp::global;
    settings.m_threads = &m_threads;
    settings.m_batchMemory = m_batchMemory;
    return settings;
}

void btFemFreeMotion::solve(const std::vector<btFemBodyRecord*>& due, const SoftPairMemory& softPairs)
{
    m_due = due;
    m_fems.clear();
    for (const btFemBodyRecord* record : m_due) m_fems.push_back(&record->fem());
    m_steady.sumImpulses(m_fems, softPairs, m_threads);
    solveDue(true);
}

// Solves again with contact damping in the step of an impact; otherwise that step would be the least damped, and bodies
// would swing back from the contact.
void btFemFreeMotion::dampTouching(const std::vector<btFemBodyRecord*>& touching)
{
    m_due.clear();
    for (btFemBodyRecord* record : touching)
    {
        StepLoads& loads = record->fem().m_body.m_loads;
        const double damping = std::max(loads.m_leastDamping, static_cast<double>(m_info.m_numericalDamping));
        if (loads.m_isHeld && !(m_info.m_contactDamping > damping)) continue;
        loads.m_leastDamping = std::max(loads.m_leastDamping, static_cast<double>(m_info.m_contactDamping));
        loads.m_isHeld = loads.m_isInContact = true;
        m_due.push_back(record);
    }
    if (!m_due.empty()) solveDue(false);
}

void btFemFreeMotion::solveDue(bool isFirst)
{
    m_bodies.clear();
    for (const btFemBodyRecord* record : m_due) m_bodies.push_back(&record->fem().m_body);
    m_batches.divide(m_bodies, m_threads.count(), m_info.m_batchBodies);
    m_motions.resize(m_due.size());
    const std::vector<Range>& batches = m_batches.batches();
    m_threads.run(static_cast<int>(batches.size()), [&](int k) { solveBatch(batches[k], isFirst); });
}

// Charges each body of the batch an equal share of the time.
void btFemFreeMotion::solveBatch(const Range& batch, bool isFirst)
{
    for (int k = batch.m_begin; k < batch.m_end && isFirst; ++k) prepare(inBatches(k));
    const btFemStopwatch watch;
    const int count = batch.m_end - batch.m_begin;
    for (int k = batch.m_begin; k < batch.m_end; ++k) m_motions[k] = motionOf(inBatches(k));
    solveFreeMotions(m_motions.data() + batch.m_begin, count);
    for (int k = batch.m_begin; k < batch.m_end; ++k) report(inBatches(k), m_motions[k]);
    const auto share = static_cast<btScalar>(watch.milliseconds() / count);
    for (int k = batch.m_begin; k < batch.m_end; ++k) inBatches(k).m_reports.m_step.m_freeMotionMs += share;
}

void btFemFreeMotion::finish(const std::vector<btFemBodyRecord*>& solved)
{
    m_isUsable.resize(solved.size());
    m_threads.run(static_cast<int>(solved.size()),
                  [&](int k) { m_isUsable[k] = canFinishStep(solved[k]->fem().m_body); });
    m_due.clear();
    m_bodies.clear();
    for (std::size_t k = 0; k < solved.size(); ++k)
    {
        Body& body = solved[k]->fem().m_body;
        if (!m_isUsable[k])  // no NaN may reach a node
        {
            solved[k]->m_reports.m_step.m_flags |= BT_FEM_BREAKDOWN;
            abandonStep(body);
            continue;
        }
        m_due.push_back(solved[k]);
        m_bodies.push_back(&body);
    }
    m_batches.divide(m_bodies, m_threads.count(), m_info.m_batchBodies);
    m_ends.resize(m_due.size());
    const std::vector<Range>& batches = m_batches.batches();
    m_threads.run(static_cast<int>(batches.size()),
                  [&](int b)
                  {
                      const Range& batch = batches[b];
                      for (int k = batch.m_begin; k < batch.m_end; ++k)
                          m_ends[k] = {&inBatches(k).fem().m_body, settingsOf(inBatches(k))};
                      finishSteps(m_ends.data() + batch.m_begin, batch.m_end - batch.m_begin);
                      for (int k = batch.m_begin; k < batch.m_end; ++k)
                          if (m_ends[k].m_isShortened) inBatches(k).m_reports.m_step.m_flags |= BT_FEM_ENERGY;
                  });
}

void btFemFreeMotion::prepare(btFemBodyRecord& record) const
{
    readBody(record);  // again, as callbacks may have written since the prediction
    FemSoftBody& fem = record.fem();
    fem.m_search.m_isInsideOut = record.m_work.m_insideOut.isAny();
    if (!readLoads(fem, record.m_work.m_lastStep)) record.m_reports.m_step.m_flags |= BT_FEM_RESTORED;
    StepLoads& loads = fem.m_body.m_loads;
    const bool hadContacts = record.m_reports.m_contacts.size() > 0, isJoined = hasJoints(record);
    if (isJoined) loads.m_leastDamping = std::max(loads.m_leastDamping, kJointDamping);
    if (hadContacts || isJoined)
    {
        loads.m_leastDamping = std::max(loads.m_leastDamping, static_cast<double>(m_info.m_contactDamping));
        loads.m_isHeld = true;
        loads.m_isInContact = loads.m_isInContact || hadContacts;
    }
    record.m_work.m_staleness = staleness(record, record.m_work.m_lastStep);
    if (record.m_work.m_staleness > 1) record.m_reports.m_step.m_flags |= BT_FEM_STALE_FACTOR;
    record.m_reports.m_step.m_detail = detailInUse(record);
    ContactPrediction::accept(fem, record.m_work.m_lastStep);
}

FreeMotion btFemFreeMotion::motionOf(btFemBodyRecord& record) const
{
    const FemSoftBody& fem = record.fem();
    FreeMotion motion;
    motion.m_body = &record.fem().m_body;
    motion.m_settings = settingsOf(record);
    if (fem.m_memory.m_predicted.empty()) return motion;
    motion.m_predicted = &fem.m_memory.m_predicted;
    motion.m_predictedFloor = residualFloor(m_info.m_contactTolerance, m_info.m_tolerance);
    return motion;
}

void btFemFreeMotion::report(btFemBodyRecord& record, const FreeMotion& motion) const
{
    btFemStepReport& report = record.m_reports.m_step;
    const SolveReport& solved = motion.m_report;
    m_note(record, motion);
    if (!motion.m_settings.m_direct && solved.m_stop == SolveStop::budget) report.m_flags |= BT_FEM_NOT_CONVERGED;
    if (!motion.m_settings.m_direct && solved.m_stop == SolveStop::breakdown) report.m_flags |= BT_FEM_BREAKDOWN;
    report.m_iterations = solved.m_iterations;
    report.m_residual = static_cast<btScalar>(solved.m_residual);
}
