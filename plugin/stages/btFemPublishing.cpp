// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemPublishing.h"

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/node_exchange.h"
#include "bullet_fem/fem/step/stepping.h"

using namespace bullet_fem;

void writeMotion(btFemBodyRecord& record)
{
    FemSoftBody& fem = record.fem();
    btFemStepReport& report = record.m_reports.m_step;
    record.m_work.m_insideOut.look(fem.m_body.m_model->mesh().tets(), fem.m_body.m_state.m_x);
    report.m_flags |= stateFlags(record) & BT_FEM_INSIDE_OUT;
    writeNodes(fem);
    finishNodes(record);
    const double length = 1e3 * record.m_work.m_lastStep / record.m_softBody->m_cfg.timescale;
    report.m_tooSlow = record.m_work.m_realTime.isTooSlow(report.m_freeMotionMs + report.m_contactMs, length);
}

void finishNodes(btFemBodyRecord& record)
{
    record.m_softBody->integrateMotion();
    record.m_work.m_isFinished = true;
}
