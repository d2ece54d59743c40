// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// RigidProxies: expected reactions of soft bodies on rigid bodies with Bullet's joints; see docs/contact.md.
#include <algorithm>
#include <utility>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kExpected = 0.5;  // relaxation factor of the expected reaction [-]; it oscillates from 2/3 on

// Relaxes the expected reaction towards the part of the present one that has persisted since the step before.
void lasting(const Vec3& now, const Vec3& before, Vec3& expected)
{
    const double square = dot(now, now), lasts = square > 0 ? std::clamp(dot(now, before) / square, 0.0, 1.0) : 0;
    expected += kExpected * (lasts * now - expected);
}

}  // namespace

void RigidProxies::noteBeforeSolve(const btCollisionObject& object)
{
    btRigidBody* body = bullet_fem::movableBody(object);
    const btMultiBodyLinkCollider* link = linkOf(object);
    if (!body && !link) return;
    const std::lock_guard<std::mutex> lock(m_beforeMutex);
    if (link) return m_articulated.noteBeforeSolve(*link->m_multiBody);
    if (std::any_of(m_before.begin(), m_before.end(), [&](const Before& b) { return b.m_object == &object; })) return;
    m_before.push_back({&object, vec3(body->getLinearVelocity()), vec3(body->getAngularVelocity()), {}, {}, {}});
    if (body->getNumConstraintRefs() > 0 && body->isActive()) expect(*body, m_before.back());
}

// Applies the expected reaction as a force: joint dampers would react to a jump of the velocity.
void RigidProxies::expect(btRigidBody& body, Before& before)
{
    const int id = broadphaseId(body);
    const auto found =
        std::find_if(m_remainders.begin(), m_remainders.end(), [id](const Remainder& r) { return r.m_objectId == id; });
    if (found == m_remainders.end() || !isAny(found->m_linearExpected, found->m_angularExpected)) return;
    before.m_expected = {found->m_linearExpected, found->m_angularExpected};
    before.m_pushed = true;
    before.m_force = body.getTotalForce();
    before.m_torque = body.getTotalTorque();
    const btMatrix3x3& turned = body.getCenterOfMassTransform().getBasis();
    const btVector3 spin = bulletVector(before.m_expected.m_angular) * turned;
    body.applyCentralForce(bulletVector((1 / m_step) * before.m_expected.m_linear) / body.getInvMass());
    body.applyTorque(turned * (body.getLocalInertia() * spin / btScalar(m_step)));
}

// Returns the velocity change that an object got in advance, and resets it: 0 at the second call, or if Bullet has put
// the object to sleep since.
LinkMotion RigidProxies::takeExpected(const btCollisionObject& object)
{
    for (Before& b : m_before)
        if (b.m_object == &object)
        {
            const LinkMotion expected = std::exchange(b.m_expected, {});
            return object.isActive() ? expected : LinkMotion();
        }
    return {};
}

// Takes the expected reaction back before Bullet's rigid solver sees it.
void RigidProxies::takeBack(const btCollisionObject& object)
{
    for (Before& b : m_before)
        if (b.m_object == &object && b.m_pushed) clearPush(b);
}

void RigidProxies::clearPush(Before& before)
{
    btRigidBody& body = *bullet_fem::movableBody(*before.m_object);
    body.clearForces();
    body.applyCentralForce(before.m_force);
    body.applyTorque(before.m_torque);
    before.m_pushed = false;
    before.m_expected = {};
}

// Removes the expected reactions of bodies without actual ones, and restores the forces, which all of Bullet's
// sub-steps share.
void RigidProxies::returnExpected()
{
    for (Before& b : m_before)
    {
        if (!b.m_pushed) continue;
        const LinkMotion expected = takeExpected(*b.m_object);
        clearPush(b);
        btRigidBody& body = *bullet_fem::movableBody(*b.m_object);
        if (!isAny(expected.m_linear, expected.m_angular)) continue;
        Remainder& r = remainderOf(broadphaseId(body));
        body.setLinearVelocity(addedExactly(body.getLinearVelocity(), -expected.m_linear, r.m_linear));
        body.setAngularVelocity(addedExactly(body.getAngularVelocity(), -expected.m_angular, r.m_angular));
    }
}

void RigidProxies::addToVelocity(btRigidBody& body, const Source& source, const LinkMotion& change, bool lasts)
{
    Remainder& remainder = remainderOf(source.m_objectId);
    remainder.m_used = true;
    if (lasts)
    {
        lasting(change.m_linear, remainder.m_linearGiven, remainder.m_linearExpected);
        lasting(change.m_angular, remainder.m_angularGiven, remainder.m_angularExpected);
        remainder.m_linearGiven = change.m_linear;
        remainder.m_angularGiven = change.m_angular;
    }
    const LinkMotion had = takeExpected(body);
    body.setLinearVelocity(addedExactly(body.getLinearVelocity(), change.m_linear - had.m_linear, remainder.m_linear));
    body.setAngularVelocity(
        addedExactly(body.getAngularVelocity(), change.m_angular - had.m_angular, remainder.m_angular));
}

}  // namespace bullet_fem
