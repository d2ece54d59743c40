// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemDetailChooser.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "plugin/record/btFemBodyRecord.h"

namespace
{

// Residual up to which one iteration is good enough. In a beam that swings by its own length and bends by more than 90
// degrees, steps below it moved the tip within .1 % of the full solution's way; the error then grows to 2 mm a step in
// a 4 m beam at residuals of .6.
constexpr double kCoarseResidual = 0.05;

}  // namespace

void btFemDetailChooser::setInterest(btFemInterest* interest, const btFemDetailPolicy& policy)
{
    std::string why;
    if (!policy.valid(&why)) throw std::invalid_argument("btFemDetailPolicy: " + why);
    m_interest = interest;
    m_policy = policy;
}

void btFemDetailChooser::choose(btFemBodyRecord& record, double step) const
{
    if (!m_interest || record.m_asked.m_detail != btFemDetail::automatic)
    {
        record.m_work.m_detailLevel = {};
        return;
    }
    const double told = m_interest->interest(*record.m_softBody);
    if (!(told >= 0 && told <= 1)) record.m_reports.m_step.m_flags |= BT_FEM_BAD_INTEREST;
    // Who cannot say how much a body matters must not see it get worse.
    record.m_work.m_detailLevel.update(std::isnan(told) ? 1 : std::clamp(told, 0.0, 1.0), step, m_policy);
}

// A body at rest has next to nothing to solve, and a large share of that left: then the tolerance is met.
void btFemDetailChooser::judge(btFemBodyRecord& record, const bullet_fem::SolveReport& solved)
{
    if (record.m_asked.m_detail != btFemDetail::automatic || detailInUse(record) == btFemDetail::nodalWarp) return;
    if (solved.m_stop != bullet_fem::SolveStop::converged && !(solved.m_residual <= kCoarseResidual))
        record.m_work.m_detailLevel.raise();
}
