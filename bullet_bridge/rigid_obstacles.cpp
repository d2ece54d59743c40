// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid_obstacles.h"

#include <algorithm>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "LinearMath/btTransformUtil.h"
#include "bullet_bridge/bullet_vectors.h"

namespace bullet_fem
{
namespace
{

Mat3 mat3(const btMatrix3x3& m)
{
    Mat3 result;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) result(i, j) = m[i][j];
    return result;
}

// A rigid body that impulses can move; null for static, kinematic and foreign objects.
btRigidBody* movable(const btCollisionObject& object)
{
    auto* body = const_cast<btRigidBody*>(btRigidBody::upcast(&object));
    return body && !body->isStaticOrKinematicObject() && body->getInvMass() > 0 ? body : nullptr;
}

Obstacle immovable(const btCollisionObject& object)
{
    Obstacle obstacle;
    obstacle.m_center = vec3(object.getWorldTransform().getOrigin());
    if (object.isKinematicObject())
    {
        obstacle.m_linearVelocity = vec3(object.getInterpolationLinearVelocity());
        obstacle.m_angularVelocity = vec3(object.getInterpolationAngularVelocity());
    }
    return obstacle;
}

// Adds `change` to a Bullet velocity, with what rounding cut off before, and keeps what it cuts off now. A component at
// a time, through memory: GCC 12 vectorises the narrowing of three components and the widening that follows into
// nothing.
btVector3 added(const btVector3& velocity, const Vec3& change, Vec3& remainder)
{
    btVector3 result(0, 0, 0);
    for (int c = 0; c < 3; ++c)
    {
        const double exact = double(velocity[c]) + remainder[c] + change[c];
        const volatile btScalar rounded = static_cast<btScalar>(exact);
        result[c] = rounded;
        remainder[c] = exact - double(rounded);
    }
    return result;
}

}  // namespace

int broadphaseId(const btCollisionObject& object)
{
    return object.getBroadphaseHandle() ? object.getBroadphaseHandle()->m_uniqueId : -1;
}

void RigidObstacles::clear()
{
    m_obstacles.clear();
    m_sources.clear();
}

int RigidObstacles::indexOf(const btCollisionObject& object, double step)
{
    for (std::size_t k = 0; k < m_sources.size(); ++k)
        if (m_sources[k].m_object == &object) return static_cast<int>(k);
    m_sources.push_back({&object, broadphaseId(object), {}, {}});
    Obstacle obstacle = immovable(object);
    if (const btRigidBody* body = movable(object))
    {
        const Mat3 factor = {{{body->getAngularFactor().x(), 0, 0},
                              {0, body->getAngularFactor().y(), 0},
                              {0, 0, body->getAngularFactor().z()}}};
        obstacle.m_inverseMass = body->getInvMass() * vec3(body->getLinearFactor());
        obstacle.m_inverseInertia = factor * mat3(body->getInvInertiaTensorWorld()) * factor;
        obstacle.m_center = vec3(body->getCenterOfMassPosition());
        obstacle.m_linearVelocity = vec3(body->getLinearVelocity()) + step * vec3(body->getGravity());
        obstacle.m_angularVelocity = vec3(body->getAngularVelocity());
    }
    m_obstacles.push_back(obstacle);
    return static_cast<int>(m_obstacles.size()) - 1;
}

RigidObstacles::Remainder& RigidObstacles::remainderOf(int objectId)
{
    for (Remainder& r : m_remainders)
        if (r.m_objectId == objectId) return r;
    m_remainders.push_back({objectId, {}, {}, true});
    return m_remainders.back();
}

void RigidObstacles::applyReactions(const std::vector<ContactPoint>& contacts, double step)
{
    for (const ContactPoint& contact : contacts)
    {
        Source& source = m_sources[contact.m_obstacle];
        source.m_linearImpulse -= contact.m_impulse;
        source.m_angularImpulse -= cross(contact.m_point - m_obstacles[contact.m_obstacle].m_center, contact.m_impulse);
    }
    for (std::size_t k = 0; k < m_sources.size(); ++k) m_sources[k].m_angularImpulse += m_obstacles[k].m_angularImpulse;
    for (Remainder& r : m_remainders) r.m_used = false;
    for (std::size_t k = 0; k < m_sources.size(); ++k)
        if (btRigidBody* body = movable(*m_sources[k].m_object)) applyTo(*body, m_sources[k], m_obstacles[k], step);
    m_remainders.erase(
        std::remove_if(m_remainders.begin(), m_remainders.end(), [](const Remainder& r) { return !r.m_used; }),
        m_remainders.end());
}

void RigidObstacles::applyTo(btRigidBody& body, const Source& source, const Obstacle& obstacle, double step)
{
    Remainder& remainder = remainderOf(source.m_objectId);
    remainder.m_used = true;
    const Vec3& J = source.m_linearImpulse;
    if (dot(J, J) + dot(source.m_angularImpulse, source.m_angularImpulse) > 0)
    {
        const Vec3 dv = {obstacle.m_inverseMass.x * J.x, obstacle.m_inverseMass.y * J.y,
                         obstacle.m_inverseMass.z * J.z};
        body.setLinearVelocity(added(body.getLinearVelocity(), dv, remainder.m_linear));
        body.setAngularVelocity(
            added(body.getAngularVelocity(), obstacle.m_inverseInertia * source.m_angularImpulse, remainder.m_angular));
        body.activate();
    }
    if (dot(obstacle.m_pushLinear, obstacle.m_pushLinear) + dot(obstacle.m_pushAngular, obstacle.m_pushAngular) == 0)
        return;
    btTransform pushed;
    btTransformUtil::integrateTransform(body.getCenterOfMassTransform(), bulletVector(obstacle.m_pushLinear),
                                        bulletVector(obstacle.m_pushAngular), btScalar(step), pushed);
    body.setCenterOfMassTransform(pushed);
}

}  // namespace bullet_fem
