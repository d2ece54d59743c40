// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rebounds.h"

#include <algorithm>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/contact/rebound.h"
#include "bullet_fem/fem/step/stepping.h"

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

// Smallest cosine between a support's normal and the direction that it holds against: 60 degrees [-].
constexpr double kHolds = 0.5;

// Largest gap of rigid bodies that rest on each other [m]: Bullet lets them tremble by less.
constexpr double kTouching = 2e-3;

// Indices of the two sides in the problem.
constexpr int kOther = 0, kBody = 1;

// A frame that moves with a velocity [m/s] for a time [s]. In it, a moving support does no work.
struct Frame
{
    Vec3 m_velocity;
    double m_time;
};

// Elastic, kinetic and gravitational energy in a frame [J].
double energyOf(const FemSoftBody& fem, const Frame& frame)
{
    const BodyState& s = fem.m_body.m_state;
    Vec3 momentum, moment;
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        momentum += s.m_mass[i] * s.m_v[i];
        moment += s.m_mass[i] * (s.m_x[i] - frame.m_time * frame.m_velocity);
    }
    return mechanicalEnergy(fem.m_body) - dot(momentum, frame.m_velocity) - dot(moment, fem.gravity());
}

// Kinetic and gravitational energy of a rigid body [J]. Links of multibodies are not counted: energy that goes into
// them counts as lost.
double energyOf(const btRigidBody& body)
{
    const Vec3 v = vec3(body.getLinearVelocity());
    const btVector3 spin = body.getAngularVelocity() * body.getWorldTransform().getBasis();
    double turning = 0;
    for (int i = 0; i < 3; ++i)
        if (body.getInvInertiaDiagLocal()[i] > 0)
            turning += double(spin[i]) * spin[i] / body.getInvInertiaDiagLocal()[i];
    return (0.5 * dot(v, v) - dot(vec3(body.getGravity()), vec3(body.getCenterOfMassPosition()))) / body.getInvMass() +
           0.5 * turning;
}

double energyOf(const btCollisionObject& object)
{
    const btRigidBody* body = btRigidBody::upcast(&object);
    return body && !body->isStaticOrKinematicObject() && body->getInvMass() > 0 ? energyOf(*body) : 0;
}

void setMotion(const LinkMotion& motion, RigidProxy& proxy)
{
    proxy.m_linearVelocity = motion.m_linear;
    proxy.m_angularVelocity = motion.m_angular;
}

RigidProxy proxyBefore(const RigidProxies& rigid, int index)
{
    RigidProxy proxy = rigid.rigidProxies()[index];
    // The rigid proxy with the object's velocity as the step begins; a rigid body's forces are not in it yet.
    const btRigidBody* body = movableBody(rigid.object(index));
    if (body)
        setMotion({vec3(body->getLinearVelocity()), vec3(body->getAngularVelocity())}, proxy);
    else
        setMotion(rigid.motionNow(index), proxy);
    return proxy;
}

int componentOf(const FemSoftBody& fem, const SurfacePoint& point)
{
    return fem.m_body.m_model->mesh().nodeComponent()[point.m_nodes[0]];
}

}  // namespace

// Collects contact patches by pair of bodies. Between two soft bodies, the one of smaller broadphase id keeps the
// impact.
void Rebounds::gather(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies)
{
    m_patches.clear();
    for (const ContactPoint& c : problem.m_contacts)
    {
        if (!(c.m_restitution > 0) || c.m_soft.m_body == c.m_other.m_body) continue;
        Patch patch;
        patch.m_body = c.m_soft.m_body;
        patch.m_component = componentOf(*bodies[patch.m_body], c.m_soft);
        patch.m_rigidProxy = c.m_rigidProxy;
        Vec3 normal = c.m_normal;
        if (c.m_other.m_body >= 0)
        {
            patch.m_otherBody = c.m_other.m_body;
            patch.m_otherComponent = componentOf(*bodies[patch.m_otherBody], c.m_other);
            if (broadphaseId(*bodies[patch.m_otherBody]->m_softBody) < broadphaseId(*bodies[patch.m_body]->m_softBody))
            {
                std::swap(patch.m_body, patch.m_otherBody);
                std::swap(patch.m_component, patch.m_otherComponent);
                normal = -normal;
            }
        }
        auto found = std::find_if(m_patches.rbegin(), m_patches.rend(), [&](const Patch& p) { return p.isOf(patch); });
        if (found == m_patches.rend())
        {
            m_patches.push_back(patch);
            found = m_patches.rbegin();
        }
        const double push = dot(c.m_impulse, c.m_normal);
        found->m_restitution = std::max(found->m_restitution, c.m_restitution);
        if (!(push > 0)) continue;
        found->m_push += push;
        found->m_point += push * (c.m_point + c.m_approach);
        found->m_normal += push * normal;
    }
}

void Rebounds::note(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies, const RigidProxies& rigid,
                    double least)
{
    for (FemSoftBody* fem : bodies)
        for (Impact& impact : fem->m_memory.m_impacts) impact.m_isNear = impact.m_isPressed = false;
    gather(problem, bodies);
    for (const Patch& patch : m_patches) notePatch({problem, bodies, rigid}, patch, least);
}

void Rebounds::notePatch(const Scene& scene, const Patch& patch, double least)
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
    }
    const auto known = std::find_if(impacts.begin(), impacts.end(), [&](const Impact& i) { return i.isOf(now); });
    if (known == impacts.end())
    {
        if (now.m_isPressed && meet(scene, patch, least, now)) impacts.push_back(now);
        return;
    }
    known->m_isNear = true;
    known->m_isPressed = now.m_isPressed;
    if (!now.m_isPressed) return;
    known->m_point = now.m_point;
    known->m_normal = now.m_normal;
}

// Starts an impact. False if the approach is too slow for a rebound.
bool Rebounds::meet(const Scene& scene, const Patch& patch, double least, Impact& impact)
{
    const FemSoftBody& fem = *scene.m_bodies[patch.m_body];
    const FemSoftBody* soft = patch.m_otherBody >= 0 ? scene.m_bodies[patch.m_otherBody] : nullptr;
    const Vec3& n = impact.m_normal;
    RigidProxy first = wholeMotion(fem.m_body, patch.m_component);
    RigidProxy second =
        soft ? wholeMotion(soft->m_body, patch.m_otherComponent) : proxyBefore(scene.m_rigid, patch.m_rigidProxy);
    if (!(dot(n, second.velocityAt(impact.m_point) - first.velocityAt(impact.m_point)) > least)) return false;
    const RigidProxy* firstSupport = supportOf(scene, patch.m_body, patch.m_component, -n);
    const RigidProxy* secondSupport =
        soft ? supportOf(scene, patch.m_otherBody, patch.m_otherComponent, n) : supportOf(scene, patch.m_rigidProxy, n);
    impact.m_isHeld = firstSupport != nullptr;
    impact.m_otherIsHeld = secondSupport != nullptr;
    if (firstSupport) first = *firstSupport;
    if (secondSupport) second = *secondSupport;
    impact.m_approach = dot(n, second.velocityAt(impact.m_point) - first.velocityAt(impact.m_point));
    if (!(impact.m_approach > least)) return false;
    impact.m_restitution = patch.m_restitution;
    impact.m_speed = -impact.m_approach;
    if (!first.canMove()) impact.m_frame = first.velocityAt(impact.m_point);
    if (!second.canMove()) impact.m_frame = second.velocityAt(impact.m_point);
    const Frame frame = {impact.m_frame, 0};
    impact.m_energy = energyOf(fem, frame) + (soft ? energyOf(*soft, frame) : energyOf(*impact.m_other));
    return true;
}

// The immovable proxy that supports a component of a body against a direction; null if there is none.
const RigidProxy* Rebounds::supportOf(const Scene& scene, int body, int component, const Vec3& against)
{
    for (const ContactPoint& c : scene.m_problem.m_contacts)
    {
        if (c.m_soft.m_body != body || c.m_rigidProxy < 0) continue;
        const RigidProxy& proxy = scene.m_problem.m_rigidProxies[c.m_rigidProxy];
        if (proxy.canMove() || !(dot(c.m_impulse, c.m_normal) > 0) || !(dot(c.m_normal, against) > kHolds)) continue;
        if (componentOf(*scene.m_bodies[body], c.m_soft) == component) return &proxy;
    }
    return nullptr;
}

const RigidProxy* Rebounds::supportOf(const Scene& scene, int rigidProxy, const Vec3& against)
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
        proxies[k] = RigidProxy();
        proxies[k].m_linearVelocity = impact.m_frame;
    }
}

// Follows an impact; true if it is over. After the body has been stopped, energy that is still in its elasticity may
// return for kPatience times the stopping time.
bool Rebounds::follow(FemSoftBody& fem, Impact& impact, const Other& other, RigidProxies& rigid, double step)
{
    setPair(fem, impact, other, rigid, step);
    const Vec3 parting = m_problem.m_rigidProxies[kBody].velocityAt(impact.m_point) -
                         m_problem.m_rigidProxies[kOther].velocityAt(impact.m_point);
    const double speed = dot(impact.m_normal, parting), gain = speed - impact.m_speed;
    impact.m_gain = std::max(impact.m_gain, gain);
    impact.m_speed = speed;
    impact.m_time += step;
    const bool isDriven = impact.m_isPressed && !(gain < kSpent * impact.m_gain);
    if (isDriven || !(speed > -kStopped * impact.m_approach)) return !impact.m_isNear;
    if (impact.m_stopTime == 0) impact.m_stopTime = impact.m_time;
    return part(fem, impact, other, rigid, step) || !impact.m_isPressed ||
           !(impact.m_time < kPatience * impact.m_stopTime);
}

// Applies the rebound impulse. True if it was applied or none is due; false if no energy is available yet.
bool Rebounds::part(FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid, double step)
{
    Rebound rebound;
    rebound.m_first = kBody;
    rebound.m_second = kOther;
    rebound.m_point = impact.m_point;
    rebound.m_normal = impact.m_normal;
    rebound.m_speed = impact.m_restitution * impact.m_approach;
    if (!(rebound.m_speed > impact.m_speed)) return true;
    const Frame frame = {impact.m_frame, impact.m_time};
    rebound.m_energy = impact.m_energy - energyOf(fem, frame) -
                       (other.m_soft ? energyOf(*other.m_soft, frame) : energyOf(*other.m_rigid));
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
    if (other.m_soft || !before[kOther].canMove()) return true;
    rigid.rigidProxies().front().m_linearVelocity += linear(kOther);
    rigid.rigidProxies().front().m_angularVelocity += angular(kOther);
    ContactPoint reaction;
    reaction.m_rigidProxy = 0;
    reaction.m_point = impact.m_point;
    reaction.m_arm = impact.m_point - before[kOther].m_center;
    reaction.m_impulse = impulse;
    m_problem.m_contacts.push_back(reaction);
    rigid.applyReactions(m_problem, step, false);
    return true;
}

bool mayRebound(const ContactProblem& problem)
{
    const auto rebounds = [](const ContactPoint& contact) { return contact.m_restitution > 0; };
    return std::any_of(problem.m_contacts.begin(), problem.m_contacts.end(), rebounds);
}

}  // namespace bullet_fem
