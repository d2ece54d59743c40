// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rebounds.h"

#include <algorithm>
#include <cmath>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/rigid/impact_start.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/contact/rebound.h"

namespace bullet_fem
{
namespace
{

// Contact drives two bodies apart while the gain of separation speed in a step exceeds this share of the largest gain
// of this impact [-]. Unlike a threshold of force, it does not depend on the time step; it cuts off the last 3 % of a
// half-sine pulse.
constexpr double kSpent = 0.1;

// Approach faster than this share of the impact speed is still being stopped [-]. Overdamped bodies only creep to rest.
constexpr double kStopped = 0.05;

// The restitution by elasticity is found anew when the patch is pressed harder by this factor [-].
constexpr double kHarder = 1.2;

// Smallest cosine between the normal and the line of two centres that counts as central: 30 degrees [-].
constexpr double kCentral = 0.87;

// The speed at which a rolling body approaches the other where the patch will be next: the patch advances by the
// relative motion of the centres in a step, and to the next facet [m/s].
double rollingSpeed(const RigidProxy& a, const RigidProxy& b, const Vec3& normal, double step, double facet)
{
    const Vec3 relative = a.m_linearVelocity - b.m_linearVelocity;
    const double advance = step * norm(relative - dot(relative, normal) * normal);
    return (advance + facet) * norm(a.m_angularVelocity - b.m_angularVelocity);
}

void setMotion(const LinkMotion& motion, RigidProxy& proxy)
{
    proxy.m_linearVelocity = motion.m_linear;
    proxy.m_angularVelocity = motion.m_angular;
}

}  // namespace

// Reserves memory for the usual pair, as a step does not allocate.
Rebounds::Rebounds(bool isElastic) : m_patches(isElastic), m_groups(m_patches)
{
    m_live.reserve(kUsualRebounds);
    m_parting.reserve(kUsualRebounds);
    m_sides.reserve(2 * kUsualRebounds);
    m_proxyOf.reserve(2 * kUsualRebounds);
    m_problem.m_rigidProxies.reserve(4 * kUsualRebounds);
    m_problem.m_responses.reserve(2 * kUsualRebounds);
    m_problem.m_contacts.reserve(kUsualRebounds);
    m_before.reserve(4 * kUsualRebounds);
    m_rebounds.reserve(kUsualRebounds);
    m_pressed.reserve(2 * kUsualRebounds);
    m_given.reserve(kUsualRebounds);
}

void Rebounds::note(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies, const RigidProxies& rigid,
                    double step, double least)
{
    for (FemSoftBody* fem : bodies)
        for (Impact& impact : fem->m_memory.m_impacts) impact.m_isNear = impact.m_isPressed = false;
    const ImpactScene scene = {problem, bodies, rigid, step};
    m_patches.gather(scene, least);
    const auto hasImpacts = [](const FemSoftBody* fem) { return !fem->m_memory.m_impacts.empty(); };
    if (m_patches.patches().empty() && std::none_of(bodies.begin(), bodies.end(), hasImpacts)) return;
    m_groups.begin(scene);
    for (std::size_t k = 0; k < m_patches.patches().size(); ++k) notePatch(scene, k, least);
    m_groups.find();
}

void Rebounds::notePatch(const ImpactScene& scene, std::size_t k, double least)
{
    const ImpactPatch& patch = m_patches.patches()[k];
    std::vector<Impact>& impacts = scene.m_bodies[patch.m_body]->m_memory.m_impacts;
    Impact now = impactAt(scene, patch);
    const auto known = std::find_if(impacts.rbegin(), impacts.rend(), [&](const Impact& i) { return i.isOf(now); });
    const bool isKnown = known != impacts.rend();
    if (isKnown) known->m_isNear = true;
    const bool isElastic = patch.m_restitution == 0 && m_patches.isElastic();
    // Other parts of two bodies that part may meet, as the ends of a brick do: the first impact is over then.
    if (now.m_isPressed && (!isKnown || known->m_speed >= 0) && meet(scene, patch, least, now))
    {
        impacts.push_back(now);
        m_groups.setImpact(k, impacts.size() - 1, isElastic);
        return;
    }
    if (!isKnown) return;
    known->m_isPressed = now.m_isPressed;
    if (!now.m_isPressed) return;
    known->m_point = now.m_point;
    known->m_normal = now.m_normal;
    known->m_impulse = now.m_impulse;
    ImpactMotions motions = motionsOf(scene, patch);
    if (known->m_isHeld) motions.m_first = immovableProxy(known->m_frame);
    if (known->m_otherIsHeld) motions.m_second = immovableProxy(known->m_frame);
    known->m_speedBefore = -motions.approachAt(*known);
    const bool isHarder = patch.m_push > kHarder * known->m_push;
    m_groups.setImpact(k, static_cast<std::size_t>(impacts.rend() - known) - 1,
                       isElastic && isHarder && known->m_stopTime == 0);
}

// Starts an impact. False if the approach is too slow for a rebound.
bool Rebounds::meet(const ImpactScene& scene, const ImpactPatch& patch, double least, Impact& impact)
{
    const ImpactMotions motions = motionsOf(scene, patch);
    const double facet = scene.m_bodies[patch.m_body]->m_body.m_model->mesh().meanEdgeLength();
    const double slowest = patch.m_restitution > 0 ? least
                                                   : least + rollingSpeed(motions.m_first, motions.m_second,
                                                                          impact.m_normal, scene.m_step, facet);
    if (!(motions.approachAt(impact) > slowest)) return false;
    beginImpact(scene, patch, motions, impact);
    return approachOf(impact) > slowest;
}

void Rebounds::give(const std::vector<FemSoftBody*>& bodies, WorldObjects& world, RigidProxies& rigid, double step)
{
    world.forget();
    m_given.clear();
    listLive(bodies, world);
    m_rigid = &rigid;
    setProxies(step);
    for (Live& live : m_live) follow(live, step);
    for (std::size_t k = 0; k < m_live.size(); ++k)
        if (m_live[k].m_isReady) partGroup(k);
    if (!m_given.empty()) rigid.applyReactions(m_problem, step, false);
    // Impacts in the order of their bodies.
    auto live = m_live.begin();
    for (FemSoftBody* fem : bodies)
    {
        std::vector<Impact>& impacts = fem->m_memory.m_impacts;
        const auto isOver = [&](const Impact&) { return (live++)->m_isOver; };
        impacts.erase(std::remove_if(impacts.begin(), impacts.end(), isOver), impacts.end());
    }
    rigid.clear();
}

// Finds the other side of an impact. None if it no longer exists or sleeps.
void Rebounds::findOther(Live& live, const std::vector<FemSoftBody*>& bodies, WorldObjects& world) const
{
    const Impact& impact = *live.m_impact;
    const btSoftBody& body = *live.m_fem->m_softBody;
    if (impact.m_otherComponent >= 0)
    {
        for (FemSoftBody* soft : bodies)
            if (soft->m_softBody == impact.m_other && broadphaseId(*soft->m_softBody) == impact.m_otherId &&
                impact.m_otherComponent < soft->m_body.m_model->mesh().componentCount())
                live.m_otherSoft = soft;
        return;
    }
    world.read(body);
    const bool isKnown = world.knows(body) ? world.holds(body, impact.m_other) : impact.m_isNear;
    if (isKnown && broadphaseId(*impact.m_other) == impact.m_otherId) live.m_otherRigid = impact.m_other;
}

void Rebounds::listLive(const std::vector<FemSoftBody*>& bodies, WorldObjects& world)
{
    m_live.clear();
    m_sides.clear();
    const auto add = [this](const ImpactSide& side)
    {
        if (std::find(m_sides.begin(), m_sides.end(), side) == m_sides.end()) m_sides.push_back(side);
    };
    for (FemSoftBody* fem : bodies)
        for (Impact& impact : fem->m_memory.m_impacts)
        {
            m_live.push_back({fem, &impact});
            Live& live = m_live.back();
            findOther(live, bodies, world);
            live.m_isOver = !live.hasOther();
            if (live.m_isOver) continue;
            add(live.side());
            add(live.otherSide());
        }
}

int Rebounds::proxyOf(const ImpactSide& side) const
{
    return m_proxyOf[std::find(m_sides.begin(), m_sides.end(), side) - m_sides.begin()];
}

// Sets up the problem of all sides with their present motion: rigid ones have their index in `rigid`.
void Rebounds::setProxies(double step)
{
    RigidProxies& rigid = *m_rigid;
    rigid.clear(RigidPhase::moved);
    m_problem.clear();
    std::vector<RigidProxy>& proxies = m_problem.m_rigidProxies;
    m_proxyOf.assign(m_sides.size(), -1);
    for (std::size_t k = 0; k < m_sides.size(); ++k)
        if (m_sides[k].m_rigid) m_proxyOf[k] = rigid.indexOf(*m_sides[k].m_rigid, step);
    rigid.links().connect(rigid.rigidProxies(), m_problem.m_responses);
    proxies.assign(rigid.rigidProxies().begin(), rigid.rigidProxies().end());
    for (std::size_t k = 0; k < proxies.size(); ++k) setMotion(rigid.motionNow(static_cast<int>(k)), proxies[k]);
    for (std::size_t k = 0; k < m_sides.size(); ++k)
    {
        if (!m_sides[k].m_soft) continue;
        m_proxyOf[k] = static_cast<int>(proxies.size());
        proxies.push_back(wholeMotion(m_sides[k].m_soft->m_body, m_sides[k].m_component));
    }
    for (Live& live : m_live)
    {
        if (live.m_isOver) continue;
        const auto proxyFor = [&](const ImpactSide& side, bool isHeld)
        {
            if (!isHeld) return proxyOf(side);
            proxies.push_back(immovableProxy(live.m_impact->m_frame));
            return static_cast<int>(proxies.size()) - 1;
        };
        live.m_first = proxyFor(live.side(), live.m_impact->m_isHeld);
        live.m_second = proxyFor(live.otherSide(), live.m_impact->m_otherIsHeld);
    }
}

// The velocity of the patch: it goes with the centre of what can move, of two such bodies between both.
Vec3 Rebounds::patchVelocity(const Live& live) const
{
    Vec3 sum;
    int count = 0;
    for (const int k : {live.m_second, live.m_first})
    {
        const RigidProxy& proxy = m_problem.m_rigidProxies[k];
        if (!proxy.canMove()) continue;
        sum += proxy.m_linearVelocity;
        ++count;
    }
    return count > 0 ? (1.0 / count) * sum : sum;
}

// The normal between two bodies that meet along the line of their centres turns with that line, as with balls.
void Rebounds::turnNormal(const Live& live, double step) const
{
    Impact& impact = *live.m_impact;
    const RigidProxy &body = m_problem.m_rigidProxies[live.m_first], &other = m_problem.m_rigidProxies[live.m_second];
    if (!body.canMove() || !other.canMove()) return;
    const Vec3 line = body.m_center - other.m_center;
    const double squared = dot(line, line);
    if (!(dot(line, impact.m_normal) > kCentral * std::sqrt(squared))) return;
    const Vec3 turn = (step / squared) * cross(line, body.m_linearVelocity - other.m_linearVelocity);
    const Vec3 turned = impact.m_normal + cross(turn, impact.m_normal);
    impact.m_normal = (1 / norm(turned)) * turned;
}

// Follows an impact, which is over when the two are apart before contact has driven them apart.
void Rebounds::follow(Live& live, double step) const
{
    if (live.m_isOver) return;
    Impact& impact = *live.m_impact;
    const std::vector<RigidProxy>& proxies = m_problem.m_rigidProxies;
    const Vec3 parting =
        proxies[live.m_first].velocityAt(impact.m_point) - proxies[live.m_second].velocityAt(impact.m_point);
    const double speed = dot(impact.m_normal, parting), gain = speed - impact.m_speed;
    if (impact.m_isPressed) impact.m_loss -= 0.5 * impact.m_impulse * (impact.m_speedBefore + speed);
    impact.m_gain = std::max(impact.m_gain, gain);
    impact.m_speed = speed;
    impact.m_time += step;
    if (impact.m_push > 0)  // a restitution by elasticity
    {
        impact.m_point += step * patchVelocity(live);
        turnNormal(live, step);
    }
    const bool isDriven = impact.m_isPressed && !(gain < kSpent * impact.m_gain);
    live.m_isReady = !isDriven && speed > -kStopped * approachOf(impact);
    if (!live.m_isReady)
        live.m_isOver = !impact.m_isNear;
    else if (impact.m_stopTime == 0)
        impact.m_stopTime = impact.m_time;
}

bool mayRebound(const ContactProblem& problem)
{
    const auto rebounds = [](const ContactPoint& contact) { return contact.m_restitution > 0; };
    return std::any_of(problem.m_contacts.begin(), problem.m_contacts.end(), rebounds);
}

}  // namespace bullet_fem
