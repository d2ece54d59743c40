// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemDetailChooser.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "plugin/record/btFemBodyRecord.h"

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
    // NaN selects full detail.
    record.m_work.m_detailLevel.update(std::isnan(told) ? 1 : std::clamp(told, 0.0, 1.0), step, m_policy);
}
