// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cmath>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_bridge/rigid/impact_energy.h"
#include "bullet_bridge/rigid/rebounds.h"
#include "bullet_fem/fem/contact/rebound.h"

namespace bullet_fem
{
namespace
{

// An impact stores energy in the elasticity of a body. The rebound may wait for it up to this multiple of the stopping
// time [-].
constexpr double kPatience = 2;

// Share of a set restitution that counts as all of it [-].
constexpr double kWhole = 0.99;

}  // namespace

// True if two impacts have a number in common and a body that can move: numbers are unique in a contact problem alone.
bool Rebounds::isOneGroup(const Live& a, const Live& b) const
{
    if (a.m_impact->m_group == 0 || a.m_impact->m_group != b.m_impact->m_group) return false;
    for (const int k : {a.m_first, a.m_second})
        if ((k == b.m_first || k == b.m_second) && m_problem.m_rigidProxies[k].canMove()) return true;
    return false;
}

// Parts an impact that is ready, with its group when all of it are. After the body has been stopped, energy that is
// still in its elasticity may return for kPatience times the stopping time.
void Rebounds::partGroup(std::size_t first)
{
    m_parting.clear();
    if (!m_live[first].m_isOver) m_parting.push_back(&m_live[first]);
    for (std::size_t p = 0; p < m_parting.size(); ++p)
        for (Live& live : m_live)
            if (!live.m_isOver && isOneGroup(*m_parting[p], live) &&
                std::find(m_parting.begin(), m_parting.end(), &live) == m_parting.end())
                m_parting.push_back(&live);
    bool isReady = true, isPressed = false;
    double wait = 0;
    for (const Live* live : m_parting)
    {
        const Impact& impact = *live->m_impact;
        isReady = isReady && live->m_isReady;
        isPressed = isPressed || impact.m_isPressed;
        if (impact.m_stopTime > 0) wait = std::max(wait, impact.m_time / impact.m_stopTime);
    }
    if (m_parting.empty() || (!isReady && wait < kPatience)) return;
    const bool mayWait = isPressed || !(m_live[first].m_impact->m_push > 0);
    if (part(m_parting) || !mayWait || !(wait < kPatience))
        for (Live* live : m_parting) live->m_isOver = true;
}

// The energy that a rebound of two may give back [J]. Vibrations of bodies that no longer press each other do not
// become rigid motion; the restitution by elasticity accounts for these.
double Rebounds::energyFor(const Live& live) const
{
    const Impact& impact = *live.m_impact;
    const bool isElastic = impact.m_push > 0;
    const MovingFrame frame = {impact.m_frame, impact.m_time};
    const auto energyLeft = [&](const FemSoftBody& body, int k)
    {
        const RigidProxy& proxy = m_problem.m_rigidProxies[k];
        return impact.m_isPressed || !isElastic || !proxy.canMove() ? energyIn(frame, body)
                                                                    : rigidEnergyIn(frame, body, proxy);
    };
    const double left =
        energyLeft(*live.m_fem, live.m_first) +
        (live.m_otherSoft ? energyLeft(*live.m_otherSoft, live.m_second) : energyOf(*live.m_otherRigid));
    return isElastic ? std::min(impact.m_energy - left, impact.m_loss) : impact.m_energy - left;
}

// That of a group [J]: what its contacts have taken from the rigid motions, and those that press do not still hold.
double Rebounds::energyForGroup(const std::vector<Live*>& parting)
{
    double energy = 0;
    m_pressed.clear();
    const auto heldBy = [this](const FemSoftBody* fem, int proxy)
    {
        const RigidProxy& whole = m_problem.m_rigidProxies[proxy];
        if (!fem || !whole.canMove() || std::find(m_pressed.begin(), m_pressed.end(), proxy) != m_pressed.end())
            return 0.0;
        m_pressed.push_back(proxy);
        return energyIn({}, *fem) - rigidEnergyIn({}, *fem, whole);
    };
    for (const Live* live : parting)
    {
        energy += live->m_impact->m_loss;
        if (!live->m_impact->m_isPressed) continue;
        energy -= heldBy(live->m_fem, live->m_first) + heldBy(live->m_otherSoft, live->m_second);
    }
    return energy;
}

// Applies the impulses of rebounds at once. True if they were applied or none is due; false if energy is missing, which
// vibrations still hold. A set restitution is completed when they have returned it or lost it.
bool Rebounds::part(const std::vector<Live*>& parting)
{
    m_rebounds.clear();
    bool isDue = false;
    for (const Live* live : parting)
    {
        Rebound rebound;
        rebound.m_first = live->m_first;
        rebound.m_second = live->m_second;
        rebound.m_point = live->m_impact->m_point;
        rebound.m_normal = live->m_impact->m_normal;
        rebound.m_speed = partingSpeedOf(*live->m_impact);
        isDue = isDue || rebound.m_speed > separationSpeed(m_problem, rebound);
        m_rebounds.push_back(rebound);
    }
    const bool isAny = std::any_of(parting.begin(), parting.end(),
                                   [](const Live* live)
                                   { return live->m_impact->m_restitution > 0 || live->m_impact->m_passedOn > 0; });
    if (!isDue || !isAny) return true;
    m_system.set(m_problem, m_rebounds);
    m_before.assign(m_problem.m_rigidProxies.begin(), m_problem.m_rigidProxies.end());
    if (!m_system.give(m_problem, m_rebounds, parting.size() > 1 ? energyForGroup(parting) : energyFor(*parting[0])))
        return false;
    for (std::size_t k = 0; k < m_before.size(); ++k)
    {
        const RigidProxy &before = m_before[k], &now = m_problem.m_rigidProxies[k];
        if (isBelow(kFastest, now.m_linearVelocity - before.m_linearVelocity) &&
            isBelow(kFastest, now.m_angularVelocity - before.m_angularVelocity))
            continue;
        m_problem.m_rigidProxies.swap(m_before);
        return true;
    }
    move(parting);
    const bool isElastic = parting.front()->m_impact->m_push > 0;
    return isElastic || !(separationSpeed(m_problem, m_rebounds.front()) < kWhole * m_rebounds.front().m_speed);
}

// Moves the bodies by the change of their proxies, and notes the impulses.
void Rebounds::move(const std::vector<Live*>& parting)
{
    const std::vector<RigidProxy>& proxies = m_problem.m_rigidProxies;
    for (std::size_t k = 0; k < m_sides.size(); ++k)
    {
        const int proxy = m_proxyOf[k];
        const Vec3 linear = proxies[proxy].m_linearVelocity - m_before[proxy].m_linearVelocity,
                   angular = proxies[proxy].m_angularVelocity - m_before[proxy].m_angularVelocity;
        if (dot(linear, linear) == 0 && dot(angular, angular) == 0) continue;
        if (m_sides[k].m_soft)
            addWholeMotion(m_sides[k].m_soft->m_body, m_sides[k].m_component, proxies[proxy].m_center, linear, angular);
        else
        {
            m_rigid->rigidProxies()[proxy].m_linearVelocity += linear;
            m_rigid->rigidProxies()[proxy].m_angularVelocity += angular;
        }
    }
    for (std::size_t k = 0; k < parting.size(); ++k)
    {
        const Live& live = *parting[k];
        const Rebound& rebound = m_rebounds[k];
        if (rebound.m_impulse == 0) continue;
        const Vec3 impulse = rebound.m_impulse * rebound.m_normal;
        const bool secondMoves = proxies[live.m_second].canMove();
        m_given.push_back({proxies[live.m_first].canMove() ? live.m_fem : nullptr,
                           secondMoves ? live.m_otherSoft : nullptr, live.m_fem->m_softBody, *live.m_impact, impulse});
        if (live.m_otherSoft || !secondMoves) continue;
        ContactPoint reaction;
        reaction.m_rigidProxy = live.m_second;
        reaction.m_point = live.m_impact->m_point;
        reaction.m_arm = live.m_impact->m_point - proxies[live.m_second].m_center;
        reaction.m_impulse = impulse;
        m_problem.m_contacts.push_back(reaction);
    }
}

}  // namespace bullet_fem
