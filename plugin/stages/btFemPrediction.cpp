// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemPrediction.h"

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/face_tree.h"
#include "bullet_bridge/body/node_exchange.h"
#include "bullet_bridge/body/rigid_dispatch.h"
#include "bullet_bridge/joints/cluster_joints.h"
#include "bullet_bridge/rigid/rigid_objects.h"
#include "bullet_fem/btFemVectors.h"
#include "fem/common/bounds.h"
#include "plugin/record/btFemTouches.h"
#include "plugin/registry/btFemBroadphaseProxy.h"
#include "plugin/setup/btFemBodySetUp.h"
#include "plugin/stages/btFemSleeping.h"

using namespace bullet_fem;

namespace
{

constexpr double kBoundsMargin = 0.6;  // margin of a body's bounds, in mean edges: rigid bodies move up to half an edge
                                       // before their contacts

// Updates the constants that btSoftBody::predictMotion sets, but keeps the rest lengths of links and moves no nodes.
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

void setBounds(FemSoftBody& fem, double step)
{
    setSweptBounds(fem, step, kBoundsMargin * fem.m_body.m_model->mesh().meanEdgeLength());
}

// Fits the leaf of a body that has been added to the world since the last step.
void fitNewLeaf(btFemBodyRecord& record, double worldStep)
{
    const int id = broadphaseId(*record.m_softBody);
    const double step = bodyStep(record, worldStep);
    if (record.m_membership.m_fittedLeaf == id || !isUsableStep(step)) return;
    record.m_membership.m_fittedLeaf = id;
    if (!record.m_softBody->isActive()) setBounds(record.fem(), step);
    fitBroadphaseLeaf(*record.m_softBody);
}

// Applies wind, pressure and volume conservation. Bullet's wind uses node velocities with gravity just added.
void applyBulletForces(const FemSoftBody& fem, double step)
{
    btSoftBody& soft = *fem.m_softBody;
    const btSoftBody::Config& cfg = soft.m_cfg;
    const bool inWind = cfg.kLF > 0 || cfg.kDG > 0;
    if (!inWind && cfg.kPR == 0 && !(cfg.kVC > 0)) return;  // Bullet would visit every face nevertheless
    const btVector3 fall = bulletVector(step * fem.gravity());
    if (!inWind || !isFinite(vec3(fall))) return soft.applyForces();
    soft.addVelocity(fall);  // only of nodes that are not pinned
    soft.applyForces();
    for (int i = 0; i < soft.m_nodes.size(); ++i) soft.m_nodes[i].m_v = fem.m_written.m_v[i];  // as just read
}

}  // namespace

bool beginBodyStep(btFemBodySetUp& setUp, btFemBodyRecord& record, double worldStep)
{
    const bool present = record.m_membership.m_present;
    record.m_work.m_stage = btFemStage::predicted;
    if (present) ageTouches(record);
    if (record.isFem())
    {
        record.fem().m_overlaps.m_rigid.clear();
        record.fem().m_overlaps.m_soft.clear();
    }
    const bool isActive = record.m_softBody->isActive();
    if (record.isFem() && !isActive) record.fem().m_memory.m_impacts.clear();
    if (!present || record.m_model.m_rejected || (record.isFem() && !isActive)) return false;
    const double step = bodyStep(record, worldStep);
    if (!isUsableStep(step)) return false;
    if (!record.isFem() || record.m_asked.m_materialChanged || restMatricesChanged(record.fem()))
        setUp.trySetUp(record, step);  // also bodies that are asleep on arrival: others have contact with them, and
                                       // saved states contain them
    if (!record.isFem()) return false;
    setUp.tryChooseSurface(record);
    if (!isActive) markForces(record);
    return isActive;
}

void predictBody(btFemBodyRecord& record, double step)
{
    FemSoftBody& fem = record.fem();
    readBody(record);
    record.m_work.m_factorMismatch = factorMismatch(fem, step);
    setBounds(fem, step);
    refreshBulletConstants(*record.m_softBody, step);
    applyBulletForces(fem, step);
}

void prepareForCollision(const btFemRecords& records, double worldStep)
{
    for (const auto& record : records)
    {
        if (!record->isStepped()) continue;
        fitNewLeaf(*record, worldStep);
        hideClusterJoints(record->fem());
        keepFaceTree(*record->m_softBody);
        // A body keeps its contacts in sleep, which Bullet begins within the step after it is wanted.
        const int activation = record->m_softBody->getActivationState();
        if (activation != ISLAND_SLEEPING && activation != WANTS_DEACTIVATION) clearBulletContacts(*record->m_softBody);
    }
}
