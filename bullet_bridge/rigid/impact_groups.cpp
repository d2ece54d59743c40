// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/impact_groups.h"

#include <algorithm>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/rigid/impact_start.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

// A patch passes an impact on if its impulse is more than this share of the impact's [-].
constexpr double kPassedOnShare = 0.05;

// True if pins, joints or Bullet's constraints do not hold a side: the mobility of a held one is not that of its mass.
bool isFree(const ImpactSide& side, const RigidProxies& rigid)
{
    if (side.m_soft)
        return side.m_soft->m_joints.m_now.empty() && wholeMotion(side.m_soft->m_body, side.m_component).canMove();
    const btRigidBody* body = movableBody(*side.m_rigid);
    return !body || !rigid.isConstrained(*body);
}

}  // namespace

// Reserves memory for the usual pair, as a step does not allocate.
ImpactGroups::ImpactGroups(ImpactPatches& patches) : m_patches(patches)
{
    m_noted.reserve(ImpactPatches::kUsualPatches);
    m_group.reserve(MeetingPatches::kMaxCount);
    m_sides.reserve(2 * MeetingPatches::kMaxCount);
    m_proxyOf.reserve(2 * MeetingPatches::kMaxCount);
    m_rebounds.reserve(MeetingPatches::kMaxCount);
    m_parting.reserve(MeetingPatches::kMaxCount);
    m_meeting.m_responses.reserve(MeetingPatches::kMaxCount);
    m_meeting.m_speed.reserve(MeetingPatches::kMaxCount);
    m_meeting.m_acceleration.reserve(MeetingPatches::kMaxCount);
    m_meeting.m_compliance.reserve(MeetingPatches::kMaxCount);
    m_problem.m_rigidProxies.reserve(ImpactPatches::kUsualPatches);
}

void ImpactGroups::begin(const ImpactScene& scene)
{
    m_scene = &scene;
    m_noted.assign(m_patches.patches().size(), Noted());
}

void ImpactGroups::setImpact(std::size_t patch, std::size_t impact, bool isDue)
{
    m_noted[patch].m_impact = static_cast<int>(impact);
    m_noted[patch].m_isDue = isDue;
}

// Finds the sides of a patch, and its impact, which begins here if it has none.
const ImpactGroups::Noted& ImpactGroups::notedOf(std::size_t k)
{
    Noted& noted = m_noted[k];
    if (noted.m_isKnown) return noted;
    noted.m_isKnown = true;
    const ImpactPatch& patch = m_patches.patches()[k];
    Impact impact;
    if (noted.m_impact >= 0)
        impact = impactOf(k);
    else
    {
        impact = impactAt(*m_scene, patch);
        beginImpact(*m_scene, patch, motionsOf(*m_scene, patch), impact);
    }
    noted.m_isFree = true;
    const auto set = [&](ImpactSide side, bool isHeld, ImpactSide& to)
    {
        if (isHeld) return;
        noted.m_isFree = noted.m_isFree && isFree(side, m_scene->m_rigid);
        if (side.m_soft || movableBody(*side.m_rigid) ||
            m_scene->m_problem.m_rigidProxies[patch.m_rigidProxy].canMove())
            to = side;
    };
    set({m_scene->m_bodies[patch.m_body], patch.m_component, nullptr}, impact.m_isHeld, noted.m_sides[0]);
    if (patch.m_otherBody >= 0)
        set({m_scene->m_bodies[patch.m_otherBody], patch.m_otherComponent, nullptr}, impact.m_otherIsHeld,
            noted.m_sides[1]);
    else
        set({nullptr, -1, &m_scene->m_rigid.object(patch.m_rigidProxy)}, impact.m_otherIsHeld, noted.m_sides[1]);
    return noted;
}

// True if a patch passes an impact on, or has done so. A patch of bodies at rest has a smaller impulse.
bool ImpactGroups::passesOn(std::size_t seed, std::size_t patch)
{
    const ImpactPatch& own = m_patches.patches()[patch];
    const Impact* impact = m_noted[patch].m_impact >= 0 ? &impactOf(patch) : nullptr;
    const bool isOld = impact && impact->m_group > 0 && impact->m_group == impactOf(seed).m_group;
    const bool isNew =
        own.m_push > kPassedOnShare * m_patches.patches()[seed].m_push && !(impact && impact->m_stopTime > 0);
    if (own.m_restitution > 0 || (!isOld && !isNew)) return false;
    const Noted& noted = notedOf(patch);
    const auto isIn = [this](const ImpactSide& side)
    { return side.isAny() && std::find(m_sides.begin(), m_sides.end(), side) != m_sides.end(); };
    return noted.m_isFree && (isIn(noted.m_sides[0]) || isIn(noted.m_sides[1]));
}

// Collects the patches that pass an impact on, and their sides.
void ImpactGroups::collect(std::size_t seed)
{
    m_group.assign(1, seed);
    m_sides.clear();
    const auto addSides = [this](std::size_t patch)
    {
        for (const ImpactSide& side : notedOf(patch).m_sides)
            if (side.isAny() && std::find(m_sides.begin(), m_sides.end(), side) == m_sides.end())
                m_sides.push_back(side);
    };
    addSides(seed);
    bool grows = true;
    while (grows)
    {
        grows = false;
        for (std::size_t k = 0; k < m_noted.size() && m_group.size() < MeetingPatches::kMaxCount; ++k)
        {
            if (std::find(m_group.begin(), m_group.end(), k) != m_group.end() || !passesOn(seed, k)) continue;
            m_group.push_back(k);
            addSides(k);
            grows = true;
        }
    }
}

void ImpactGroups::find()
{
    for (std::size_t k = 0; k < m_noted.size(); ++k)
        if (m_noted[k].m_isDue) findGroup(k);
}

void ImpactGroups::findGroup(std::size_t seed)
{
    const auto keep = [this](std::size_t k)
    {
        m_noted[k].m_isDue = false;
        impactOf(k).m_push = m_patches.patches()[k].m_push;
    };
    keep(seed);
    impactOf(seed).m_restitution = 0;
    impactOf(seed).m_passedOn = 0;
    if (!notedOf(seed).m_isFree) return;
    collect(seed);
    for (const std::size_t k : m_group)
    {
        if (m_noted[k].m_impact < 0)
        {
            const ImpactPatch& patch = m_patches.patches()[k];
            Impact impact = impactAt(*m_scene, patch);
            beginImpact(*m_scene, patch, motionsOf(*m_scene, patch), impact);
            m_noted[k].m_impact = static_cast<int>(impactsOf(k).size());
            impactsOf(k).push_back(impact);
        }
        keep(k);
    }
    write(setUp() && findPartingSpeeds(m_meeting, m_parting));
}

int ImpactGroups::proxyOf(const ImpactSide& side)
{
    const auto found = std::find(m_sides.begin(), m_sides.end(), side);
    return m_proxyOf[found - m_sides.begin()];
}

// Sets up the rigid motions of the group; the loads give them their velocities in a second.
void ImpactGroups::setProxies()
{
    const ContactProblem& problem = m_scene->m_problem;
    std::vector<RigidProxy>& proxies = m_problem.m_rigidProxies;
    m_problem.clear();
    proxies.assign(problem.m_rigidProxies.begin(), problem.m_rigidProxies.end());
    m_problem.m_responses.assign(problem.m_responses.begin(), problem.m_responses.end());
    for (RigidProxy& proxy : proxies) proxy.m_linearVelocity = proxy.m_angularVelocity = {};
    m_proxyOf.clear();
    for (const ImpactSide& side : m_sides)
    {
        m_proxyOf.push_back(side.m_rigid ? m_scene->m_rigid.find(*side.m_rigid) : static_cast<int>(proxies.size()));
        if (side.m_soft) proxies.push_back(wholeMotion(side.m_soft->m_body, side.m_component));
        const btRigidBody* rigid = side.m_rigid ? movableBody(*side.m_rigid) : nullptr;
        RigidProxy& proxy = proxies[m_proxyOf.back()];
        proxy.m_linearVelocity = side.m_soft ? side.m_soft->gravity() : rigid ? vec3(rigid->getGravity()) : Vec3();
        proxy.m_angularVelocity = {};
    }
}

void ImpactGroups::setRebounds()
{
    const int held = static_cast<int>(m_problem.m_rigidProxies.size());
    m_problem.m_rigidProxies.push_back({});
    m_rebounds.clear();
    for (const std::size_t k : m_group)
    {
        const ImpactSide* sides = notedOf(k).m_sides;
        Rebound rebound;
        rebound.m_first = sides[0].isAny() ? proxyOf(sides[0]) : held;
        rebound.m_second = sides[1].isAny() ? proxyOf(sides[1]) : held;
        rebound.m_point = impactOf(k).m_point;
        rebound.m_normal = impactOf(k).m_normal;
        m_rebounds.push_back(rebound);
    }
}

// Sets up the patches that meet. False if their elasticity is not known.
bool ImpactGroups::setUp()
{
    setProxies();
    setRebounds();
    m_meeting.m_responses.clear();
    m_meeting.m_speed.clear();
    for (const std::size_t k : m_group)
    {
        m_meeting.m_speed.push_back(-dot(impactOf(k).m_velocity, impactOf(k).m_normal));
        m_meeting.m_responses.push_back({});
        if (!m_patches.addResponse(*m_scene, m_patches.patches()[k], m_meeting.m_responses.back())) return false;
    }
    m_system.set(m_problem, m_rebounds);
    const int count = static_cast<int>(m_group.size());
    m_meeting.m_compliance.clear();
    m_meeting.m_acceleration.clear();
    for (int p = 0; p < count; ++p)
    {
        for (int q = 0; q < count; ++q) m_meeting.m_compliance.push_back(m_system.compliance(p, q));
        m_meeting.m_acceleration.push_back(-separationSpeed(m_problem, m_rebounds[p]));
    }
    return true;
}

// Writes the speeds that are found. Several impacts get a number in common.
void ImpactGroups::write(bool isParting)
{
    int number = 0;
    if (m_group.size() > 1)
        for (const FemSoftBody* fem : m_scene->m_bodies)
            for (const Impact& impact : fem->m_memory.m_impacts) number = std::max(number, impact.m_group + 1);
    for (std::size_t p = 0; p < m_group.size(); ++p)
    {
        Impact& impact = impactOf(m_group[p]);
        impact.m_group = number;
        impact.m_restitution = impact.m_passedOn = 0;
        if (!isParting) continue;
        const double approach = approachOf(impact);
        if (approach > 0) impact.m_restitution = std::min(std::max(m_parting[p] / approach, 0.0), 1.0);
        if (m_group.size() > 1) impact.m_passedOn = m_parting[p] - impact.m_restitution * approach;
    }
}

}  // namespace bullet_fem
