// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemReports.h"
#include "bullet_fem/fem/factor/body_model.h"

/// Writes size and factor of a body's model to a report.
inline void reportModel(const bullet_fem::BodyModel& model, btFemStepReport& report)
{
    report.m_nodes = model.nodeCount();
    report.m_tets = model.mesh().tetCount();
    const bullet_fem::FactorReport& factor = model.factorReport();
    report.m_factorEntries = factor.m_entries;
    report.m_factorMegabytes = static_cast<btScalar>(1e-6 * static_cast<double>(factor.m_bytes));
    report.m_fullFactorMegabytes = static_cast<btScalar>(1e-6 * static_cast<double>(factor.m_fullBytes));
    report.m_lowMemory = factor.m_path == bullet_fem::FactorPath::lowMemory;
    report.m_factorSeconds = static_cast<btScalar>(factor.m_seconds);
    report.m_bakedFactor = factor.m_baked;
}
