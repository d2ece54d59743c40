// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/snapshot/btFemEntrySnapshot.h"

#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/cluster_joints.h"
#include "bullet_fem/btFemHelpers.h"
#include "fem/common/message.h"
#include "plugin/bodies/btFemModelReport.h"
#include "plugin/joints/btFemAttachments.h"
#include "plugin/policy/btFemFactorThread.h"

using namespace bullet_fem;

namespace
{

btFemNeighbour withoutScratch(btFemNeighbour neighbour)
{
    neighbour.m_here = false;
    return neighbour;
}

void checkReports(const btFemEntrySnapshot& s)
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

void restoreReports(const btFemEntrySnapshot& s, const WorldIds& world, btFemEntry& entry)
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
    takeOver(s.m_contacts, entry.m_contacts);
    takeOver(s.m_touches, entry.m_touches);
    writeReports(*entry.m_fem, entry.m_anchors);
    entry.m_setUpFlags = s.m_setUpFlags;
    entry.m_message = s.m_message;
    btFemStepReport report = s.m_report;
    report.m_message = entry.m_message.c_str();
    reportModel(*entry.m_fem->m_body.m_model, report);
    report.m_tooSlow = entry.m_report.m_tooSlow;  // which the clock said
    entry.m_report = report;
}

void restoreSleep(const btFemEntrySnapshot& s, const WorldIds& world, btFemSleep& sleep)
{
    sleep = s.m_sleep;
    for (const auto& item : s.m_neighbours)
    {
        btFemNeighbour neighbour = item.m_value;
        neighbour.m_object = world.objectOf(item.m_other);
        // What is gone is recognised by being nowhere, and wakes the body if it touched or held it.
        if (!neighbour.m_object)
        {
            neighbour.m_touches = neighbour.m_touches || neighbour.m_held;
            neighbour.m_held = false;
        }
        sleep.m_neighbours.push_back(neighbour);
    }
}

}  // namespace

btFemEntrySnapshot snapshotOf(const btFemEntry& entry, const WorldIds& world)
{
    const btSoftBody& soft = *entry.m_softBody;
    const FemSoftBody& fem = *entry.m_fem;
    btFemEntrySnapshot s;
    s.m_id = world.idOf(&soft);
    s.m_nodeCount = soft.m_nodes.size();
    s.m_tetCount = soft.m_tetras.size();
    s.m_materialGiven = entry.m_materialGiven;
    s.m_materialChanged = entry.m_materialChanged;
    s.m_material = entry.m_material;
    s.m_body = snapshotOf(fem.m_body);
    s.m_hasFormerFactor =
        entry.m_formerModel && entry.m_formerModel->sharedShape() == fem.m_body.m_model->sharedShape();
    if (s.m_hasFormerFactor) s.m_formerFactor = entry.m_formerModel->factorInput();
    s.m_nodes = nodeSnapshotOf(fem);
    s.m_contact = contactSnapshotOf(fem, world);
    s.m_setUpFlags = entry.m_setUpFlags;
    s.m_message = entry.m_message;
    s.m_report = entry.m_report;
    for (int k = 0; k < entry.m_contacts.size(); ++k)
        s.m_contacts.push_back({entry.m_contacts[k], world.idOf(entry.m_contacts[k].m_other)});
    for (int k = 0; k < entry.m_touches.size(); ++k)
        s.m_touches.push_back({entry.m_touches[k], world.idOf(entry.m_touches[k].m_other)});
    s.m_sleep = entry.m_sleep;
    s.m_sleep.m_neighbours.clear();
    for (const btFemNeighbour& neighbour : entry.m_sleep.m_neighbours)
        s.m_neighbours.push_back({withoutScratch(neighbour), world.idOf(neighbour.m_object)});
    s.m_lastStep = entry.m_lastStep;
    s.m_detailLevel = entry.m_detailLevel;
    s.m_factorAccount = entry.m_factorAccount;
    return s;
}

void check(const btFemEntrySnapshot& s, const btFemEntry& entry, const WorldIds& world)
{
    const FemSoftBody& fem = *entry.m_fem;
    const btSoftBody& soft = *entry.m_softBody;
    if (s.m_nodeCount != soft.m_nodes.size() || s.m_tetCount != soft.m_tetras.size())
        reject("it was saved with ", s.m_nodeCount, " nodes and ", s.m_tetCount, " tetrahedra, and now has ",
               soft.m_nodes.size(), " and ", soft.m_tetras.size());
    if (s.m_materialGiven != entry.m_materialGiven || s.m_material != entry.m_material)
        reject("its material is another than when the state was saved; set the old one before restoring");
    check(s.m_body, *fem.m_body.m_model);
    check(s.m_nodes, fem);
    check(s.m_contact, fem, world);
    checkReports(s);
    if (!(s.m_lastStep >= 0) || !std::isfinite(s.m_lastStep))
        reject("its last step is ", s.m_lastStep, " s, not in [0, inf)");
    if (!s.m_detailLevel.valid()) reject("its level of detail is none");
}

void restore(const btFemEntrySnapshot& s, const WorldIds& world, btFemEntry& entry)
{
    FemSoftBody& fem = *entry.m_fem;
    entry.m_factorJob.reset();
    entry.m_materialChanged = s.m_materialChanged;
    entry.m_stage = btFemStage::none;
    restore(s.m_body, fem.m_body);
    restore(s.m_nodes, fem);
    restore(s.m_contact, world, fem);
    restoreReports(s, world, entry);
    restoreSleep(s, world, entry.m_sleep);
    entry.m_lastStep = s.m_lastStep;
    entry.m_detailLevel = s.m_detailLevel;
    entry.m_factorAccount = s.m_factorAccount;
    showClusterJoints(fem);
    btFemHelpers::updateEmbeddedSurface(entry.m_softBody);
}
