// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/impact_start.h"

#include "bullet_bridge/rigid/impact_energy.h"
#include "bullet_fem/fem/contact/rebound.h"

namespace bullet_fem
{
namespace
{

// Smallest cosine between a support's normal and the direction that it holds against: 60 degrees [-].
constexpr double kHolds = 0.5;

// Largest gap of rigid bodies that rest on each other [m]: Bullet lets them tremble by less.
constexpr double kTouching = 2e-3;

// The immovable proxy that supports a component of a body against a direction; null if there is none.
const RigidProxy* supportOf(const ImpactScene& scene, int body, int component, const Vec3& against)
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

// True if a push at a point of a rigid proxy presses a contact of it, and does not lift it there as a push on the other
// end of a seesaw does.
bool presses(const RigidProxy& proxy, const Vec3& point, const Vec3& push, const RigidContact& touch)
{
    if (proxy.m_responseCount > 0) return true;
    const Vec3& m = proxy.m_inverseMass;
    const Vec3 linear = {m.x * push.x, m.y * push.y, m.z * push.z};
    const Vec3 angular = proxy.m_inverseInertia * cross(point - proxy.m_center, push);
    return dot(touch.m_normal, linear + cross(angular, touch.m_arm)) < 0;
}

const RigidProxy* supportOf(const ImpactScene& scene, int rigidProxy, const Vec3& point, const Vec3& against)
{
    static const RigidProxy atRest;
    const RigidProxy& proxy = scene.m_problem.m_rigidProxies[rigidProxy];
    for (const RigidContact& touch : scene.m_problem.m_rigidContacts)
        if (touch.m_rigidProxy == rigidProxy && touch.m_isSupport && touch.m_gap <= kTouching &&
            dot(touch.m_normal, against) > kHolds && presses(proxy, point, -against, touch))
            return &atRest;
    return nullptr;
}

}  // namespace

ImpactMotions motionsOf(const ImpactScene& scene, const ImpactPatch& patch)
{
    return {wholeMotion(scene.m_bodies[patch.m_body]->m_body, patch.m_component),
            patch.m_otherBody >= 0 ? wholeMotion(scene.m_bodies[patch.m_otherBody]->m_body, patch.m_otherComponent)
                                   : scene.before(patch.m_rigidProxy)};
}

RigidProxy immovableProxy(const Vec3& velocity)
{
    RigidProxy proxy;
    proxy.m_linearVelocity = velocity;
    return proxy;
}

Impact impactAt(const ImpactScene& scene, const ImpactPatch& patch)
{
    const btCollisionObject* other = patch.m_otherBody >= 0 ? scene.m_bodies[patch.m_otherBody]->m_softBody
                                                            : &scene.m_rigid.object(patch.m_rigidProxy);
    const double size = norm(patch.m_normal);
    Impact now;
    now.m_other = other;
    now.m_otherId = broadphaseId(*other);
    now.m_component = patch.m_component;
    now.m_otherComponent = patch.m_otherComponent;
    now.m_isNear = true;
    now.m_isPressed = size > 0;
    if (!now.m_isPressed) return now;
    now.m_point = (1 / patch.m_push) * patch.m_point;
    now.m_normal = (1 / size) * patch.m_normal;
    now.m_impulse = size;
    return now;
}

void beginImpact(const ImpactScene& scene, const ImpactPatch& patch, ImpactMotions motions, Impact& impact)
{
    const FemSoftBody& fem = *scene.m_bodies[patch.m_body];
    const FemSoftBody* soft = patch.m_otherBody >= 0 ? scene.m_bodies[patch.m_otherBody] : nullptr;
    const Vec3& n = impact.m_normal;
    const RigidProxy* firstSupport = supportOf(scene, patch.m_body, patch.m_component, -n);
    const RigidProxy* secondSupport = soft ? supportOf(scene, patch.m_otherBody, patch.m_otherComponent, n)
                                           : supportOf(scene, patch.m_rigidProxy, impact.m_point, n);
    impact.m_isHeld = firstSupport != nullptr;
    impact.m_otherIsHeld = secondSupport != nullptr;
    if (firstSupport) motions.m_first = *firstSupport;
    if (secondSupport) motions.m_second = *secondSupport;
    impact.m_velocity = motions.m_first.velocityAt(impact.m_point) - motions.m_second.velocityAt(impact.m_point);
    impact.m_restitution = patch.m_restitution;
    impact.m_speed = impact.m_speedBefore = dot(impact.m_normal, impact.m_velocity);
    if (!motions.m_first.canMove()) impact.m_frame = motions.m_first.velocityAt(impact.m_point);
    if (!motions.m_second.canMove()) impact.m_frame = motions.m_second.velocityAt(impact.m_point);
    const MovingFrame frame = {impact.m_frame, 0};
    impact.m_energy = energyIn(frame, fem) + (soft ? energyIn(frame, *soft) : energyOf(*impact.m_other));
}

}  // namespace bullet_fem
