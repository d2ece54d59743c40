// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/snapshot/btFemRecordSnapshot.h"

#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/cluster_joints.h"
#include "bullet_bridge/rigid/rigid_objects.h"
#include "bullet_fem/btFemHelpers.h"
#include "fem/common/message.h"
#include "plugin/joints/btFemAttachments.h"
#include "plugin/record/btFemModelReport.h"
#include "plugin/setup/btFemFactorThread.h"

using namespace bullet_fem;

namespace
{

btFemNeighbour withoutScratch(btFemNeighbour neighbour)
{
    neighbour.m_here = false;
    return neighbour;
}

void checkReports(const btFemRecordSnapshot& s)
{
    for (const auto& contact : s.m_contacts)
        for (int a = 0; a < contact.m_value.m_nodeCount; ++a)
            if (contact.m_value.m_nodes[a] < 0 || contact.m_value.m_nodes[a] >= s.m_nodeCount)
                reject("a reported contact has node ", contact.m_value.m_nodes[a]);
    for (const auto& touch : s.m_touches)
        if (touch.m_value.m_state < btFemTouchState::began || touch.m_value.m_state > btFemTouchState::ended)
            reject("the state of a touch is ", static_cast<int>(touch.m_value.m_state), ", not in [0, 2]");
    if (s.m_report.m_detail < btFemDetail::nodalWarp || s.m_report.m_detail > btFemDetail::automatic)
        reject("the detail of a report is ", static_cast<int>(s.m_report.m_detail), ", not in [0, 4]");
}

void restoreReports(const btFemRecordSnapshot& s, const WorldIds& world, btFemBodyRecord& record)
{
    const auto takeOver = [&world](const auto& from, auto& to)
    {
        to.resize(0);
        for (const auto& item : from)
        {
            const btCollisionObject* other = world.objectOf(item.m_other);
            if (!other) continue;
            to.push_back(item.m_value);
            to[to.size() - 1].m_other = other;
        }
    };
    takeOver(s.m_contacts, record.m_reports.m_contacts);
    takeOver(s.m_touches, record.m_reports.m_touches);
    writeReports(record.fem(), record.m_reports.m_anchors);
    record.m_model.m_flags = s.m_setUpFlags;
    record.m_model.m_message = s.m_message;
    btFemStepReport report = s.m_report;
    report.m_message = record.m_model.m_message.c_str();
    reportModel(*record.fem().m_body.m_model, report);
    report.m_tooSlow = record.m_reports.m_step.m_tooSlow;  // depends on the clock, so it is not saved
    record.m_reports.m_step = report;
}

void restoreSleep(const btFemRecordSnapshot& s, const WorldIds& world, btFemSleepRecord& sleep)
{
    sleep = s.m_sleep;
    for (const auto& item : s.m_neighbours)
    {
        btFemNeighbour neighbour = item.m_value;
        neighbour.m_object = world.objectOf(item.m_other);
        // An object that is gone has no pointer; it wakes the body if it was in contact or joined.
        if (!neighbour.m_object)
        {
            neighbour.m_touches = neighbour.m_touches || neighbour.m_held;
            neighbour.m_held = false;
        }
        sleep.m_neighbours.push_back(neighbour);
    }
}

}  // namespace

btFemRecordSnapshot snapshotOf(const btFemBodyRecord& record, const WorldIds& world)
{
    const btSoftBody& soft = *record.m_softBody;
    const FemSoftBody& fem = record.fem();
    btFemRecordSnapshot s;
    s.m_id = world.idOf(&soft);
    s.m_nodeCount = soft.m_nodes.size();
    s.m_tetCount = soft.m_tetras.size();
    s.m_materialGiven = record.m_asked.m_materialGiven;
    s.m_materialChanged = record.m_asked.m_materialChanged;
    s.m_materialMark = markOf(record.m_asked.m_materials);
    s.m_body = snapshotOf(fem.m_body);
    s.m_hasFormerFactor = record.m_model.m_formerModel &&
                          record.m_model.m_formerModel->sharedShape() == fem.m_body.m_model->sharedShape();
    if (s.m_hasFormerFactor) s.m_formerFactor = record.m_model.m_formerModel->factorInput();
    s.m_nodes = nodeSnapshotOf(fem);
    s.m_contact = contactSnapshotOf(fem, world);
    s.m_setUpFlags = record.m_model.m_flags;
    s.m_message = record.m_model.m_message;
    s.m_report = record.m_reports.m_step;
    for (int k = 0; k < record.m_reports.m_contacts.size(); ++k)
        s.m_contacts.push_back({record.m_reports.m_contacts[k], world.idOf(record.m_reports.m_contacts[k].m_other)});
    for (int k = 0; k < record.m_reports.m_touches.size(); ++k)
        s.m_touches.push_back({record.m_reports.m_touches[k], world.idOf(record.m_reports.m_touches[k].m_other)});
    s.m_sleep = record.m_work.m_sleep;
    s.m_sleep.m_neighbours.clear();
    for (const btFemNeighbour& neighbour : record.m_work.m_sleep.m_neighbours)
        s.m_neighbours.push_back({withoutScratch(neighbour), world.idOf(neighbour.m_object)});
    s.m_lastStep = record.m_work.m_lastStep;
    s.m_detailLevel = record.m_work.m_detailLevel;
    s.m_factorAccount = record.m_work.m_factorAccount;
    s.m_insideOut = record.m_work.m_insideOut;
    return s;
}

void check(const btFemRecordSnapshot& s, const btFemBodyRecord& record, const WorldIds& world)
{
    const FemSoftBody& fem = record.fem();
    const btSoftBody& soft = *record.m_softBody;
    if (s.m_nodeCount != soft.m_nodes.size() || s.m_tetCount != soft.m_tetras.size())
        reject("it was saved with ", s.m_nodeCount, " nodes and ", s.m_tetCount, " tetrahedra, and now has ",
               soft.m_nodes.size(), " and ", soft.m_tetras.size(),
               "; what has split since stays so: save after it split, or restore to a world that is built anew");
    if (s.m_materialGiven != record.m_asked.m_materialGiven || s.m_materialMark != markOf(record.m_asked.m_materials))
        reject("its material is another than when the state was saved; set the old one before restoring");
    check(s.m_body, *fem.m_body.m_model);
    check(s.m_nodes, fem);
    check(s.m_contact, fem, world);
    checkReports(s);
    if (!(s.m_lastStep >= 0) || !std::isfinite(s.m_lastStep))
        reject("its last step is ", s.m_lastStep, " s, not in [0, inf)");
    if (!s.m_detailLevel.valid()) reject("its level of detail is none");
    if (!s.m_insideOut.valid()) reject("the part of its elements that is looked at next is none");
}

void restore(const btFemRecordSnapshot& s, const WorldIds& world, btFemBodyRecord& record)
{
    FemSoftBody& fem = record.fem();
    record.m_work.m_factorJob.reset();
    record.m_asked.m_materialChanged = s.m_materialChanged;
    record.m_work.m_stage = btFemStage::none;
    record.m_membership.m_fittedLeaf = broadphaseId(*record.m_softBody);  // states of worlds contain the leaves
    restore(s.m_body, fem.m_body);
    restore(s.m_nodes, fem);
    restore(s.m_contact, world, fem);
    restoreReports(s, world, record);
    restoreSleep(s, world, record.m_work.m_sleep);
    record.m_work.m_lastStep = s.m_lastStep;
    record.m_work.m_detailLevel = s.m_detailLevel;
    record.m_work.m_factorAccount = s.m_factorAccount;
    record.m_work.m_insideOut = s.m_insideOut;
    showClusterJoints(fem);
    btFemHelpers::updateEmbeddedSurface(record.m_softBody);
}
