// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rebounds.h"

#include <algorithm>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_bridge/rigid/impact_energy.h"
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

// An impact stores energy in the elasticity of a body. The rebound may wait for it up to this multiple of the stopping
// time [-].
constexpr double kPatience = 2;

// The restitution by elasticity is found anew when the patch is pressed harder by this factor [-].
constexpr double kHarder = 1.2;

// Share of a set restitution that counts as all of it [-].
constexpr double kWhole = 0.99;

// Smallest cosine between the normal and the line of two centres that counts as central: 30 degrees [-].
constexpr double kCentral = 0.87;

// Smallest cosine between a support's normal and the direction that it holds against: 60 degrees [-].
constexpr double kHolds = 0.5;

// Largest gap of rigid bodies that rest on each other [m]: Bullet lets them tremble by less.
constexpr double kTouching = 2e-3;

// Indices of the two sides in the problem.
constexpr int kOther = 0, kBody = 1;

// The speed at which a rolling body approaches the other where the patch will be next: the patch advances by the
// relative motion of the centres in a step, and to the next facet [m/s].
double rollingSpeed(const RigidProxy& a, const RigidProxy& b, const Vec3& normal, double step, double facet)
{
    const Vec3 relative = a.m_linearVelocity - b.m_linearVelocity;
    const double advance = step * norm(relative - dot(relative, normal) * normal);
    return (advance + facet) * norm(a.m_angularVelocity - b.m_angularVelocity);
}

RigidProxy immovable(const Vec3& velocity)
{
    RigidProxy proxy;
    proxy.m_linearVelocity = velocity;
    return proxy;
}

void setMotion(const LinkMotion& motion, RigidProxy& proxy)
{
    proxy.m_linearVelocity = motion.m_linear;
    proxy.m_angularVelocity = motion.m_angular;
}

}  // namespace

// Reserves memory for the usual pair, as a step does not allocate.
Rebounds::Rebounds(bool isElastic) : m_patches(isElastic)
{
    m_problem.m_rigidProxies.reserve(2);
    m_problem.m_contacts.reserve(1);
    m_given.reserve(kUsualRebounds);
}

void Rebounds::note(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies, const RigidProxies& rigid,
                    double step, double least)
{
    for (FemSoftBody* fem : bodies)
        for (Impact& impact : fem->m_memory.m_impacts) impact.m_isNear = impact.m_isPressed = false;
    const ImpactScene scene = {problem, bodies, rigid, step};
    m_patches.gather(scene, least);
    for (const ImpactPatch& patch : m_patches.patches()) notePatch(scene, patch, least);
}

void Rebounds::notePatch(const ImpactScene& scene, const ImpactPatch& patch, double least)
{
    const btCollisionObject* other = patch.m_otherBody >= 0 ? scene.m_bodies[patch.m_otherBody]->m_softBody
                                                            : &scene.m_rigid.object(patch.m_rigidProxy);
    std::vector<Impact>& impacts = scene.m_bodies[patch.m_body]->m_memory.m_impacts;
    const double size = norm(patch.m_normal);
    Impact now;
    now.m_other = other;
    now.m_otherId = broadphaseId(*other);
    now.m_component = patch.m_component;
    now.m_otherComponent = patch.m_otherComponent;
    now.m_isNear = true;
    now.m_isPressed = size > 0;
    if (now.m_isPressed)
    {
        now.m_point = (1 / patch.m_push) * patch.m_point;
        now.m_normal = (1 / size) * patch.m_normal;
        now.m_impulse = size;
    }
    const auto known = std::find_if(impacts.rbegin(), impacts.rend(), [&](const Impact& i) { return i.isOf(now); });
    const bool isKnown = known != impacts.rend();
    if (isKnown) known->m_isNear = true;
    // Other parts of two bodies that part may meet, as the ends of a brick do: the first impact is over then.
    if (now.m_isPressed && (!isKnown || known->m_speed >= 0) && meet(scene, patch, least, now))
    {
        findRestitution(scene, patch, now);
        impacts.push_back(now);
        return;
    }
    if (!isKnown) return;
    known->m_isPressed = now.m_isPressed;
    if (!now.m_isPressed) return;
    known->m_point = now.m_point;
    known->m_normal = now.m_normal;
    known->m_impulse = now.m_impulse;
    Sides sides = sidesOf(scene, patch);
    if (known->m_isHeld) sides.m_first = immovable(known->m_frame);
    if (known->m_otherIsHeld) sides.m_second = immovable(known->m_frame);
    known->m_speedBefore = -sides.approachAt(*known);
    if (known->m_stopTime == 0) findRestitution(scene, patch, *known);
}

// Finds the restitution by elasticity where none is set, anew when the patch is pressed harder.
void Rebounds::findRestitution(const ImpactScene& scene, const ImpactPatch& patch, Impact& impact)
{
    if (patch.m_restitution > 0 || !m_patches.isElastic() || !(patch.m_push > kHarder * impact.m_push)) return;
    impact.m_push = patch.m_push;
    impact.m_restitution = m_patches.elasticRestitutionOf(scene, patch, impact);
}

Rebounds::Sides Rebounds::sidesOf(const ImpactScene& scene, const ImpactPatch& patch)
{
    return {wholeMotion(scene.m_bodies[patch.m_body]->m_body, patch.m_component),
            patch.m_otherBody >= 0 ? wholeMotion(scene.m_bodies[patch.m_otherBody]->m_body, patch.m_otherComponent)
                                   : scene.before(patch.m_rigidProxy)};
}

// Starts an impact. False if the approach is too slow for a rebound.
bool Rebounds::meet(const ImpactScene& scene, const ImpactPatch& patch, double least, Impact& impact)
{
    const FemSoftBody& fem = *scene.m_bodies[patch.m_body];
    const FemSoftBody* soft = patch.m_otherBody >= 0 ? scene.m_bodies[patch.m_otherBody] : nullptr;
    const Vec3& n = impact.m_normal;
    Sides sides = sidesOf(scene, patch);
    const double facet = fem.m_body.m_model->mesh().meanEdgeLength();
    const double slowest =
        patch.m_restitution > 0 ? least : least + rollingSpeed(sides.m_first, sides.m_second, n, scene.m_step, facet);
    if (!(sides.approachAt(impact) > slowest)) return false;
    const RigidProxy* firstSupport = supportOf(scene, patch.m_body, patch.m_component, -n);
    const RigidProxy* secondSupport =
        soft ? supportOf(scene, patch.m_otherBody, patch.m_otherComponent, n) : supportOf(scene, patch.m_rigidProxy, n);
    impact.m_isHeld = firstSupport != nullptr;
    impact.m_otherIsHeld = secondSupport != nullptr;
    if (firstSupport) sides.m_first = *firstSupport;
    if (secondSupport) sides.m_second = *secondSupport;
    impact.m_velocity = sides.m_first.velocityAt(impact.m_point) - sides.m_second.velocityAt(impact.m_point);
    if (!(approachOf(impact) > slowest)) return false;
    impact.m_restitution = patch.m_restitution;
    impact.m_speed = impact.m_speedBefore = -approachOf(impact);
    if (!sides.m_first.canMove()) impact.m_frame = sides.m_first.velocityAt(impact.m_point);
    if (!sides.m_second.canMove()) impact.m_frame = sides.m_second.velocityAt(impact.m_point);
    const MovingFrame frame = {impact.m_frame, 0};
    impact.m_energy = energyIn(frame, fem) + (soft ? energyIn(frame, *soft) : energyOf(*impact.m_other));
    return true;
}

// The immovable proxy that supports a component of a body against a direction; null if there is none.
const RigidProxy* Rebounds::supportOf(const ImpactScene& scene, int body, int component, const Vec3& against)
{
    for (const ContactPoint& c : scene.m_problem.m_contacts)
    {
        if (c.m_soft.m_body != body || c.m_rigidProxy < 0) continue;
        const RigidProxy& proxy = scene.m_problem.m_rigidProxies[c.m_rigidProxy];
        if (proxy.canMove() || !(dot(c.m_impulse, c.m_normal) > 0) || !(dot(c.m_normal, against) > kHolds)) continue;
        if (scene.componentOf(c.m_soft) == component) return &proxy;
    }
    return nullptr;
}

const RigidProxy* Rebounds::supportOf(const ImpactScene& scene, int rigidProxy, const Vec3& against)
{
    static const RigidProxy atRest;
    for (const RigidContact& touch : scene.m_problem.m_rigidContacts)
        if (touch.m_rigidProxy == rigidProxy && touch.m_isSupport && touch.m_gap <= kTouching &&
            dot(touch.m_normal, against) > kHolds)
            return &atRest;
    return nullptr;
}

void Rebounds::give(const std::vector<FemSoftBody*>& bodies, WorldObjects& world, RigidProxies& rigid, double step)
{
    world.forget();
    m_given.clear();
    for (FemSoftBody* fem : bodies)
    {
        std::vector<Impact>& impacts = fem->m_memory.m_impacts;
        const auto isOver = [&](Impact& impact)
        {
            const Other other = otherOf(*fem, impact, bodies, world);
            if (!other.m_soft && !other.m_rigid) return true;
            return follow(*fem, impact, other, rigid, step);
        };
        impacts.erase(std::remove_if(impacts.begin(), impacts.end(), isOver), impacts.end());
    }
    rigid.clear();
}

// Finds the other side of an impact. Empty if it no longer exists or sleeps.
Rebounds::Other Rebounds::otherOf(const FemSoftBody& fem, const Impact& impact, const std::vector<FemSoftBody*>& bodies,
                                  WorldObjects& world) const
{
    Other other;
    if (impact.m_otherComponent >= 0)
    {
        for (FemSoftBody* soft : bodies)
            if (soft->m_softBody == impact.m_other && broadphaseId(*soft->m_softBody) == impact.m_otherId &&
                impact.m_otherComponent < soft->m_body.m_model->mesh().componentCount())
                other.m_soft = soft;
        return other;
    }
    world.read(*fem.m_softBody);
    const bool isKnown = world.knows(*fem.m_softBody) ? world.holds(*fem.m_softBody, impact.m_other) : impact.m_isNear;
    if (isKnown && broadphaseId(*impact.m_other) == impact.m_otherId) other.m_rigid = impact.m_other;
    return other;
}

// Sets up the problem of both sides with their present motion.
void Rebounds::setPair(const FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid,
                       double step)
{
    rigid.clear(RigidPhase::moved);
    m_problem.clear();
    std::vector<RigidProxy>& proxies = m_problem.m_rigidProxies;
    if (other.m_rigid)
    {
        rigid.indexOf(*other.m_rigid, step);
        rigid.links().connect(rigid.rigidProxies(), m_problem.m_responses);
        proxies.push_back(rigid.rigidProxies().front());
        setMotion(rigid.motionNow(0), proxies[kOther]);
    }
    else
        proxies.push_back(wholeMotion(other.m_soft->m_body, impact.m_otherComponent));
    proxies.push_back(wholeMotion(fem.m_body, impact.m_component));
    for (const int k : {kOther, kBody})
    {
        if (!(k == kBody ? impact.m_isHeld : impact.m_otherIsHeld)) continue;
        proxies[k] = immovable(impact.m_frame);
    }
}

// The velocity of the patch: it goes with the centre of what can move, of two such bodies between both.
Vec3 Rebounds::patchVelocity() const
{
    Vec3 sum;
    int count = 0;
    for (const RigidProxy& proxy : m_problem.m_rigidProxies)
    {
        if (!proxy.canMove()) continue;
        sum += proxy.m_linearVelocity;
        ++count;
    }
    return count > 0 ? (1.0 / count) * sum : sum;
}

// The normal between two bodies that meet along the line of their centres turns with that line, as with balls.
void Rebounds::turnNormal(Impact& impact, double step) const
{
    const RigidProxy &body = m_problem.m_rigidProxies[kBody], &other = m_problem.m_rigidProxies[kOther];
    if (!body.canMove() || !other.canMove()) return;
    const Vec3 line = body.m_center - other.m_center;
    const double squared = dot(line, line);
    if (!(dot(line, impact.m_normal) > kCentral * std::sqrt(squared))) return;
    const Vec3 turn = (step / squared) * cross(line, body.m_linearVelocity - other.m_linearVelocity);
    const Vec3 turned = impact.m_normal + cross(turn, impact.m_normal);
    impact.m_normal = (1 / norm(turned)) * turned;
}

// Follows an impact; true if it is over. After the body has been stopped, energy that is still in its elasticity may
// return for kPatience times the stopping time.
bool Rebounds::follow(FemSoftBody& fem, Impact& impact, const Other& other, RigidProxies& rigid, double step)
{
    setPair(fem, impact, other, rigid, step);
    const Vec3 parting = m_problem.m_rigidProxies[kBody].velocityAt(impact.m_point) -
                         m_problem.m_rigidProxies[kOther].velocityAt(impact.m_point);
    const double speed = dot(impact.m_normal, parting), gain = speed - impact.m_speed;
    if (impact.m_isPressed) impact.m_loss -= 0.5 * impact.m_impulse * (impact.m_speedBefore + speed);
    impact.m_gain = std::max(impact.m_gain, gain);
    impact.m_speed = speed;
    impact.m_time += step;
    if (impact.m_push > 0)  // a restitution by elasticity
    {
        impact.m_point += step * patchVelocity();
        turnNormal(impact, step);
    }
    const bool isDriven = impact.m_isPressed && !(gain < kSpent * impact.m_gain);
    if (isDriven || !(speed > -kStopped * approachOf(impact))) return !impact.m_isNear;
    if (impact.m_stopTime == 0) impact.m_stopTime = impact.m_time;
    const bool mayWait = impact.m_isPressed || !(impact.m_push > 0);
    return part(fem, impact, other, rigid, step) || !mayWait || !(impact.m_time < kPatience * impact.m_stopTime);
}

// Applies the rebound impulse. True if it was applied or none is due; false if energy is missing, which vibrations
// still hold. A set restitution is completed when they have returned it or lost it.
bool Rebounds::part(FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid, double step)
{
    Rebound rebound;
    rebound.m_first = kBody;
    rebound.m_second = kOther;
    rebound.m_point = impact.m_point;
    rebound.m_normal = impact.m_normal;
    rebound.m_speed = impact.m_restitution * approachOf(impact);
    if (!(impact.m_restitution > 0) || !(rebound.m_speed > impact.m_speed)) return true;
    const MovingFrame frame = {impact.m_frame, impact.m_time};
    // Vibrations of bodies that no longer press each other do not become rigid motion; the restitution by elasticity
    // accounts for these.
    const bool isElastic = impact.m_push > 0;
    const auto energyLeft = [&](const FemSoftBody& body, int k)
    {
        return impact.m_isPressed || !isElastic || !m_problem.m_rigidProxies[k].canMove()
                   ? energyIn(frame, body)
                   : rigidEnergyIn(frame, body, m_problem.m_rigidProxies[k]);
    };
    rebound.m_energy = impact.m_energy - energyLeft(fem, kBody) -
                       (other.m_soft ? energyLeft(*other.m_soft, kOther) : energyOf(*other.m_rigid));
    if (isElastic) rebound.m_energy = std::min(rebound.m_energy, impact.m_loss);
    const RigidProxy before[] = {m_problem.m_rigidProxies[kOther], m_problem.m_rigidProxies[kBody]};
    const Vec3 impulse = giveRebound(m_problem, rebound);
    if (dot(impulse, impulse) == 0) return false;
    const auto linear = [&](int k)
    { return m_problem.m_rigidProxies[k].m_linearVelocity - before[k].m_linearVelocity; };
    const auto angular = [&](int k)
    { return m_problem.m_rigidProxies[k].m_angularVelocity - before[k].m_angularVelocity; };
    for (const int k : {kOther, kBody})
        if (!isBelow(kFastest, linear(k)) || !isBelow(kFastest, angular(k))) return true;
    const auto move = [&](FemSoftBody& body, int component, int k)
    {
        if (before[k].canMove()) addWholeMotion(body.m_body, component, before[k].m_center, linear(k), angular(k));
    };
    move(fem, impact.m_component, kBody);
    if (other.m_soft) move(*other.m_soft, impact.m_otherComponent, kOther);
    m_given.push_back({before[kBody].canMove() ? &fem : nullptr, before[kOther].canMove() ? other.m_soft : nullptr,
                       fem.m_softBody, impact, impulse});
    const double parting = dot(impact.m_normal, m_problem.m_rigidProxies[kBody].velocityAt(impact.m_point) -
                                                    m_problem.m_rigidProxies[kOther].velocityAt(impact.m_point));
    const bool isWhole = isElastic || !(parting < kWhole * rebound.m_speed);
    if (other.m_soft || !before[kOther].canMove()) return isWhole;
    rigid.rigidProxies().front().m_linearVelocity += linear(kOther);
    rigid.rigidProxies().front().m_angularVelocity += angular(kOther);
    ContactPoint reaction;
    reaction.m_rigidProxy = 0;
    reaction.m_point = impact.m_point;
    reaction.m_arm = impact.m_point - before[kOther].m_center;
    reaction.m_impulse = impulse;
    m_problem.m_contacts.push_back(reaction);
    rigid.applyReactions(m_problem, step, false);
    return isWhole;
}

bool mayRebound(const ContactProblem& problem)
{
    const auto rebounds = [](const ContactPoint& contact) { return contact.m_restitution > 0; };
    return std::any_of(problem.m_contacts.begin(), problem.m_contacts.end(), rebounds);
}

}  // namespace bullet_fem
