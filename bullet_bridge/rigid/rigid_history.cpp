// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rigid_history.h"

#include <algorithm>
#include <utility>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kRounding = 1e-5;  // relative rounding error of velocity differences
constexpr double kExpected = 0.5;   // relaxation factor of the expected reaction [-]; it oscillates from 2/3 on

// Relaxes the expected reaction towards the part of the present one that has persisted since the step before.
void lasting(const Vec3& now, const Vec3& before, Vec3& expected)
{
    const double square = dot(now, now), lasts = square > 0 ? std::clamp(dot(now, before) / square, 0.0, 1.0) : 0;
    expected += kExpected * (lasts * now - expected);
}

}  // namespace

void RigidHistory::restore(const Memory& memory)
{
    m_remainders.assign(memory.m_remainders.begin(), memory.m_remainders.end());
    m_rewound.assign(memory.m_rewound.begin(), memory.m_rewound.end());
    listRemainders();
}

void RigidHistory::beginStep(double step)
{
    m_step = step;
    m_remainders.erase(
        std::remove_if(m_remainders.begin(), m_remainders.end(), [](const Remainder& r) { return !r.m_used; }),
        m_remainders.end());
    for (Remainder& r : m_remainders) r.m_used = false;
    listRemainders();
    m_before.clear();
    m_beforeOfBody.clear();
    m_lastRewound.swap(m_rewound);
    m_rewound.clear();
}

void RigidHistory::listRemainders()
{
    m_remainderOfId.clear();
    for (std::size_t k = 0; k < m_remainders.size(); ++k) m_remainderOfId.add(m_remainders[k].m_objectId, k);
}

RigidHistory::Remainder& RigidHistory::remainderOf(const btCollisionObject& object)
{
    const int id = broadphaseId(object), known = m_remainderOfId.find(id);
    if (known >= 0) return m_remainders[known];
    m_remainderOfId.add(id, m_remainders.size());
    m_remainders.push_back({id, {}, {}, true, {}, {}, {}, {}});
    return m_remainders.back();
}

bool RigidHistory::wasRewound(const btCollisionObject& object) const
{
    return std::find(m_lastRewound.begin(), m_lastRewound.end(), broadphaseId(object)) != m_lastRewound.end();
}

void RigidHistory::noteBeforeSolve(btRigidBody& body)
{
    if (m_beforeOfBody.find(&body) >= 0) return;
    m_beforeOfBody.add(&body, m_before.size());
    m_before.push_back({&body, vec3(body.getLinearVelocity()), vec3(body.getAngularVelocity()), {}, {}, {}});
    if (body.getNumConstraintRefs() > 0 && body.isActive()) expect(m_before.back());
}

// Applies the expected reaction as a force: joint dampers would react to a jump of the velocity.
void RigidHistory::expect(Before& before)
{
    btRigidBody& body = *before.m_body;
    const int known = m_remainderOfId.find(broadphaseId(body));
    if (known < 0 || !isAny(m_remainders[known].m_linearExpected, m_remainders[known].m_angularExpected)) return;
    before.m_expected = {m_remainders[known].m_linearExpected, m_remainders[known].m_angularExpected};
    before.m_pushed = true;
    before.m_force = body.getTotalForce();
    before.m_torque = body.getTotalTorque();
    const btMatrix3x3& turned = body.getCenterOfMassTransform().getBasis();
    const btVector3 spin = bulletVector(before.m_expected.m_angular) * turned;
    body.applyCentralForce(bulletVector((1 / m_step) * before.m_expected.m_linear) / body.getInvMass());
    body.applyTorque(turned * (body.getLocalInertia() * spin / btScalar(m_step)));
}

LinkMotion RigidHistory::doneByBullet(const btRigidBody& body, double step, const RigidProxy& rigidProxy) const
{
    const int known = m_beforeOfBody.find(&body);
    if (known < 0) return {};
    const Vec3 after = vec3(body.getLinearVelocity());
    const Vec3 forces = step * body.getInvMass() * vec3(body.getTotalForce());
    const Vec3 torques = step * (rigidProxy.m_inverseInertia * vec3(body.getTotalTorque()));
    LinkMotion done = {after - m_before[known].m_linear - forces,
                       vec3(body.getAngularVelocity()) - m_before[known].m_angular - torques};
    if (norm(done.m_linear) < kRounding * (norm(after) + norm(forces))) done.m_linear = {};
    return done;
}

LinkMotion RigidHistory::supportOf(const btRigidBody& body, double step, const RigidProxy& rigidProxy, bool rewound)
{
    const LinkMotion done = doneByBullet(body, step, rigidProxy);
    const auto part = [](const Vec3& whole, const Vec3& needed)
    {
        const double square = dot(whole, whole);
        return square > 0 ? std::clamp(dot(whole, needed) / square, 0.0, 1.0) * whole : Vec3();
    };
    const Remainder& memory = remainderOf(body);
    const Vec3 gravity = rewound ? Vec3() : step * vec3(body.getGravity());
    return {part(done.m_linear, -(gravity + memory.m_linearGiven)), part(done.m_angular, -memory.m_angularGiven)};
}

LinkMotion RigidHistory::takeExpected(const btRigidBody& body)
{
    const int known = m_beforeOfBody.find(&body);
    if (known < 0) return {};
    const LinkMotion expected = std::exchange(m_before[known].m_expected, {});
    return body.isActive() ? expected : LinkMotion();
}

void RigidHistory::takeBack(const btRigidBody& body)
{
    const int known = m_beforeOfBody.find(&body);
    if (known >= 0 && m_before[known].m_pushed) clearPush(m_before[known]);
}

void RigidHistory::clearPush(Before& before)
{
    before.m_body->clearForces();
    before.m_body->applyCentralForce(before.m_force);
    before.m_body->applyTorque(before.m_torque);
    before.m_pushed = false;
    before.m_expected = {};
}

void RigidHistory::returnExpected()
{
    for (Before& b : m_before)
    {
        if (!b.m_pushed) continue;
        const LinkMotion expected = takeExpected(*b.m_body);
        clearPush(b);
        if (!isAny(expected.m_linear, expected.m_angular)) continue;
        Remainder& r = remainderOf(*b.m_body);
        b.m_body->setLinearVelocity(addedExactly(b.m_body->getLinearVelocity(), -expected.m_linear, r.m_linear));
        b.m_body->setAngularVelocity(addedExactly(b.m_body->getAngularVelocity(), -expected.m_angular, r.m_angular));
    }
}

void RigidHistory::addToVelocity(btRigidBody& body, const LinkMotion& change, bool lasts)
{
    Remainder& remainder = remainderOf(body);
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
