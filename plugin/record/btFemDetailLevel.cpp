// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/record/btFemDetailLevel.h"

namespace
{

int levelOf(double interest, double reduced, double full)
{
    return interest >= full ? 2 : interest >= reduced ? 1 : 0;
}

}  // namespace

void btFemDetailLevel::update(double interest, double step, const btFemDetailPolicy& policy)
{
    const int wanted = levelOf(interest, policy.m_reducedFrom, policy.m_fullFrom);
    const int bearable = levelOf(interest, policy.m_reducedUntil, policy.m_fullUntil);  // never below `wanted`
    m_seconds += step;
    int level = m_level;
    if (!m_begun || wanted > m_level)
        level = wanted;
    else if (bearable < m_level && m_seconds >= policy.m_dwell)
        level = bearable;
    if (!m_begun || level != m_level) m_seconds = 0;
    m_level = level;
    m_begun = true;
}

btFemDetail btFemDetailLevel::detail() const
{
    return m_level == 2 ? btFemDetail::nodalWarp : m_level == 1 ? btFemDetail::oneIteration : btFemDetail::direct;
}
