// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/record/btFemBodyRecord.h"

#include <limits>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/node_exchange.h"
#include "bullet_bridge/body/soft_body_mesh.h"

using namespace bullet_fem;

namespace
{

constexpr double kSameFactor =
    1 + 2e-3;  // maximum ratio of step or mass of a factor that does not count as stale: a copy elsewhere may share it

constexpr double kDeepShare = 0.01;  // minimum depth over a body's size for BT_FEM_PENETRATING

}  // namespace

ElementMaterials materialsOf(const btFemBodyRecord& record)
{
    return record.m_asked.m_materialGiven ? record.m_asked.m_materials : unsetMaterialOf(*record.m_softBody);
}

btFemDetail detailInUse(const btFemBodyRecord& record)
{
    const bool automatic = record.m_asked.m_detail == btFemDetail::automatic;
    const btFemDetail detail = automatic ? record.m_work.m_detailLevel.detail() : record.m_asked.m_detail;
    const bool isDriven = record.isFem() && record.fem().m_body.m_actuators.hasPulls();
    if (record.m_reports.m_contacts.size() == 0 && !isDriven) return detail;
    if (detail == btFemDetail::direct && !automatic) return btFemDetail::globalWarp;
    return detail == btFemDetail::globalWarp ? detail : btFemDetail::nodalWarp;
}

double staleness(const btFemBodyRecord& record, double step)
{
    const Body& body = record.fem().m_body;
    if (body.m_model->factorInput().m_fixed != body.m_state.m_fixed) return std::numeric_limits<double>::infinity();
    const double mismatch = factorMismatch(record.fem(), step);
    return mismatch > kSameFactor ? mismatch : 1;
}

int stateFlags(const btFemBodyRecord& record)
{
    const bool isDeep = record.m_reports.m_step.m_deepestPenetration > kDeepShare * record.fem().m_surface.size();
    return (isDeep ? BT_FEM_PENETRATING : 0) | (record.m_work.m_insideOut.isAny() ? BT_FEM_INSIDE_OUT : 0);
}

double bodyStep(const btFemBodyRecord& record, double worldStep)
{
    return worldStep * record.m_softBody->m_cfg.timescale;
}

void readBody(btFemBodyRecord& record)
{
    const NodeReadReport read = readNodes(record.fem());
    int& flags = record.m_reports.m_step.m_flags;
    if (read.m_restored) flags |= BT_FEM_RESTORED;
    if (read.m_badMass) flags |= BT_FEM_BAD_MASS;
    if (read.m_stalePins) flags |= BT_FEM_STALE_FACTOR;
}
