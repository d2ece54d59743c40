// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/policy/btFemDetailChooser.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "plugin/bodies/btFemBodyRegistry.h"

namespace
{

// Residual up to which one iteration is good enough. In a beam that swings by its own length and bends by more than 90
// degrees, steps below it moved the tip within .1 % of the full solution's way; the error then grows to 2 mm a step in
// a 4 m beam at residuals of .6.
constexpr double kCoarse = 0.05;

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

void btFemDetailLevel::raise()
{
    if (m_level == 2) return;
    ++m_level;
    m_seconds = 0;
}

btFemDetail btFemDetailLevel::detail() const
{
    return m_level == 2 ? btFemDetail::nodalWarp : m_level == 1 ? btFemDetail::oneIteration : btFemDetail::direct;
}

void btFemDetailChooser::setInterest(btFemInterest* interest, const btFemDetailPolicy& policy)
{
    std::string why;
    if (!policy.valid(&why)) throw std::invalid_argument("btFemDetailPolicy: " + why);
    m_interest = interest;
    m_policy = policy;
}

void btFemDetailChooser::choose(btFemEntry& entry, double step) const
{
    if (!m_interest || entry.m_detail != btFemDetail::automatic)
    {
        entry.m_detailLevel = {};
        return;
    }
    const double told = m_interest->interest(*entry.m_softBody);
    if (!(told >= 0 && told <= 1)) entry.m_report.m_flags |= BT_FEM_BAD_INTEREST;
    // Who cannot say how much a body matters must not see it get worse.
    entry.m_detailLevel.update(std::isnan(told) ? 1 : std::clamp(told, 0.0, 1.0), step, m_policy);
}

// A body at rest has next to nothing to solve, and a large share of that left: then the tolerance is met.
void btFemDetailChooser::judge(btFemEntry& entry, const bullet_fem::SolveReport& solved)
{
    if (entry.m_detail != btFemDetail::automatic || detailInUse(entry) == btFemDetail::nodalWarp) return;
    if (solved.m_stop != bullet_fem::SolveStop::converged && !(solved.m_residual <= kCoarse))
        entry.m_detailLevel.raise();
}

btFemDetail detailInUse(const btFemEntry& entry)
{
    const bool automatic = entry.m_detail == btFemDetail::automatic;
    const btFemDetail detail = automatic ? entry.m_detailLevel.detail() : entry.m_detail;
    if (entry.m_contacts.size() == 0) return detail;
    if (detail == btFemDetail::direct && !automatic) return btFemDetail::globalWarp;
    return detail == btFemDetail::globalWarp ? detail : btFemDetail::nodalWarp;
}
