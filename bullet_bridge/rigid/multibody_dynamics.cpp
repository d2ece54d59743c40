// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/multibody_dynamics.h"

#include <algorithm>
#include <utility>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

void addGravity(btMultiBody& body, const Vec3& gravity)
{
    if (dot(gravity, gravity) == 0) return;
    body.addBaseForce(body.getBaseMass() * bulletVector(gravity));
    for (int k = 0; k < body.getNumLinks(); ++k) body.addLinkForce(k, body.getLinkMass(k) * bulletVector(gravity));
}

}  // namespace

bool canMove(const btMultiBodyLinkCollider& link)
{
    const btMultiBody* body = link.m_multiBody;
    if (!body || link.isStaticOrKinematicObject() || link.m_link >= body->getNumLinks()) return false;
    if (!body->isAwake() && !body->getCanWakeup()) return false;
    return link.m_link < 0 ? !body->isBaseStaticOrKinematic() : true;
}

bool sleeps(const btMultiBody& body)
{
    const auto isAsleep = [](const btCollisionObject* collider)
    { return collider && collider->getActivationState() == ISLAND_SLEEPING; };
    bool asleep = isAsleep(body.getBaseCollider());
    for (int k = 0; k < body.getNumLinks() && !asleep; ++k) asleep = isAsleep(body.getLinkCollider(k));
    return asleep;
}

void wakeIfAsleep(btMultiBody& body)
{
    if (!sleeps(body)) return;
    body.wakeUp();
    const auto activate = [](btCollisionObject* collider)
    {
        if (collider && !collider->isActive()) collider->activate();
    };
    activate(body.getBaseCollider());
    for (int k = 0; k < body.getNumLinks(); ++k) activate(body.getLinkCollider(k));
}

LinkMotion motionOf(const btMultiBodyLinkCollider& link, std::vector<btVector3>& scratch)
{
    const std::size_t count = link.m_multiBody->getNumLinks() + 1, k = link.m_link + 1;
    if (scratch.size() < 2 * count) scratch.resize(2 * count);
    link.m_multiBody->compTreeLinkVelocities(&scratch[0], &scratch[count]);
    const btMatrix3x3& fromLink = link.getWorldTransform().getBasis();
    return {vec3(fromLink * scratch[count + k]), vec3(fromLink * scratch[k])};
}

void setVelocity(btMultiBody& body, const std::vector<btScalar>& velocity)
{
    body.setBaseOmega(btVector3(velocity[0], velocity[1], velocity[2]));
    body.setBaseVel(btVector3(velocity[3], velocity[4], velocity[5]));
    for (int k = 0; k < body.getNumLinks(); ++k)
    {
        const btMultibodyLink& link = body.getLink(k);
        for (int d = 0; d < link.m_dofCount; ++d)
            body.getJointVelMultiDof(k)[d] = velocity[kBaseCoordinates + link.m_dofOffset + d];
    }
}

// Uses a time step of 0, which changes no velocity. Joint feedback is detached meanwhile, because the user
// reads it. Accelerations of kinematic joints are set to 0: Bullet does not compute them.
void MultiBodyDynamics::factor(btMultiBody& body)
{
    m_velocity.reserve(kBaseCoordinates + body.getNumDofs());  // displace() may be called in a later step
    m_turns.reserve(body.getNumLinks() + 1);
    m_feedback.resize(body.getNumLinks());
    for (int k = 0; k < body.getNumLinks(); ++k)
        m_feedback[k] = std::exchange(body.getLink(k).m_jointFeedback, nullptr);
    addGravity(body, m_takenGravity);
    body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, m_scalars, m_vectors, m_matrices, false, false, false);
    addGravity(body, -m_takenGravity);
    for (int k = 0; k < body.getNumLinks(); ++k) body.getLink(k).m_jointFeedback = m_feedback[k];
    const btScalar* acceleration = &m_scalars[body.getNumDofs()];
    m_acceleration.assign(acceleration, acceleration + kBaseCoordinates + body.getNumDofs());
    for (int k = 0; k < body.getNumLinks(); ++k)
        if (body.isLinkAndAllAncestorsKinematic(k))
            std::fill_n(m_acceleration.begin() + kBaseCoordinates + body.getLink(k).m_dofOffset,
                        body.getLink(k).m_dofCount, 0.0);
}

void MultiBodyDynamics::respond(const btMultiBody& body, const btScalar* impulse, btScalar* change)
{
    body.calcAccelerationDeltasMultiDof(impulse, change, m_scalars, m_vectors);
}

// Bullet omits joints that it does not move, and the rotation of planar joints, which is added here.
void MultiBodyDynamics::fillRows(const btMultiBody& body, int link, const Vec3& center, btScalar* J, btScalar* answer)
{
    const int coordinates = kBaseCoordinates + body.getNumDofs();
    for (int row = 0; row < 6; ++row, J += coordinates, answer += coordinates)
    {
        btVector3 axis(0, 0, 0);
        axis[row % 3] = 1;
        const btVector3 none(0, 0, 0);
        body.fillConstraintJacobianMultiDof(link, bulletVector(center), row < 3 ? none : axis, row < 3 ? axis : none, J,
                                            m_scalars, m_vectors, m_matrices);
        for (int k = link; k >= 0 && row >= 3; k = body.getParent(k))
            if (body.getLink(k).m_jointType == btMultibodyLink::ePlanar)
                J[kBaseCoordinates + body.getLink(k).m_dofOffset] +=
                    body.worldDirToLocal(k, axis).dot(body.getLink(k).getAxisTop(0));
        respond(body, J, answer);
    }
}

// The velocity is set as the multibody's own meanwhile, because stepPositionsMultiDof() ignores velocities passed to it
// in planar joints.
void MultiBodyDynamics::displace(btMultiBody& body, const std::vector<btScalar>& velocity, double step)
{
    const btScalar* now = body.getVelocityVector();
    m_velocity.assign(now, now + kBaseCoordinates + body.getNumDofs());
    setVelocity(body, velocity);
    body.stepPositionsMultiDof(static_cast<btScalar>(step));
    setVelocity(body, m_velocity);
    body.updateCollisionObjectWorldTransforms(m_turns, m_vectors);
}

MultiBodyDynamics::Momentum MultiBodyDynamics::momentumOf(const btMultiBody& body)
{
    const int count = body.getNumLinks() + 1;
    m_vectors.resize(2 * count);
    body.compTreeLinkVelocities(&m_vectors[0], &m_vectors[count]);
    Momentum sum;
    for (int k = -1; k < body.getNumLinks(); ++k)
    {
        const btVector3 inertia = k < 0 ? body.getBaseInertia() : body.getLinkInertia(k);
        const double mass = k < 0 ? body.getBaseMass() : body.getLinkMass(k);
        const Vec3 p = mass * vec3(body.localDirToWorld(k, m_vectors[count + k + 1]));
        sum.m_linear += p;
        sum.m_angular += cross(vec3(body.localPosToWorld(k, btVector3(0, 0, 0))), p) +
                         vec3(body.localDirToWorld(k, inertia * m_vectors[k + 1]));
    }
    return sum;
}

}  // namespace bullet_fem
