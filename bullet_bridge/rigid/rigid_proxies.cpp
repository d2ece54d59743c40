// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rigid_proxies.h"

#include <algorithm>
#include <functional>

#include "BulletDynamics/ConstraintSolver/btTypedConstraint.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "LinearMath/btTransformUtil.h"
#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_bridge/geometry/shapes/swept_distance.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

RigidProxy immovable(const btCollisionObject& object)
{
    RigidProxy rigidProxy;
    rigidProxy.m_center = vec3(object.getWorldTransform().getOrigin());
    if (object.isKinematicObject() && object.isActive())  // Bullet does not move sleeping ones
    {
        rigidProxy.m_linearVelocity = vec3(object.getInterpolationLinearVelocity());
        rigidProxy.m_angularVelocity = vec3(object.getInterpolationAngularVelocity());
    }
    return rigidProxy;
}

// Removes from a velocity change its component against the direction in which a body is held.
Vec3 heldBack(const Vec3& change, const Vec3& holding)
{
    const double against = dot(change, holding);
    return against < 0 ? change - (against / dot(holding, holding)) * holding : change;
}

// True if the relative motion is so fast that the object must be rewound. Speed that gravity adds in a step does not
// count, as resting bodies have it as well, except for small bodies that fall far by it.
bool isFastRelativeTo(const Body& soft, const btCollisionObject& object, const LinkMotion& now, double byGravity,
                      double step)
{
    const btTransform& present = object.getWorldTransform();
    const ShapeLeaf whole = {object.getCollisionShape(), {mat3(present.getBasis()), vec3(present.getOrigin())}, {}, {}};
    const RigidMotion motion = {vec3(present.getOrigin()), now.m_linear, now.m_angular};
    const double speed = fastestNode(soft, motion.m_linearVelocity), edge = soft.m_model->mesh().meanEdgeLength();
    const SweptShape swept(whole, motion, step);
    return isFast(swept, speed - 2 * byGravity, edge) || fallsFar(swept, byGravity / step, edge);
}

// Adds the impulses of contacts and joints up. Rigid proxies beyond `sources` belong to cloth; -1 is none.
template <class Source>
void sumImpulses(const ContactProblem& problem, const std::vector<RigidProxy>& rigidProxies,
                 std::vector<Source>& sources)
{
    const auto isOurs = [&](int k) { return k >= 0 && k < static_cast<int>(sources.size()); };
    const auto add = [&](int k, const Vec3& impulse, const Vec3& arm)
    {
        if (!isOurs(k)) return;
        sources[k].m_linearImpulse += impulse;
        sources[k].m_angularImpulse += cross(arm, impulse);
    };
    const auto addEnd = [&](const JointEnd& end, const Vec3& impulse)
    {
        if (end.m_angular && isOurs(end.m_rigidProxy))
            sources[end.m_rigidProxy].m_angularImpulse += impulse;
        else if (isOurs(end.m_rigidProxy))
            add(end.m_rigidProxy, impulse, end.m_point - rigidProxies[end.m_rigidProxy].m_center);
    };
    for (const ContactPoint& contact : problem.m_contacts) add(contact.m_rigidProxy, -contact.m_impulse, contact.m_arm);
    for (const Joint& joint : problem.m_joints)
    {
        addEnd(joint.m_a, joint.m_impulse);
        addEnd(joint.m_b, -joint.m_impulse);
    }
    for (const TorsionalFriction& torsion : problem.m_torsions)
        sources[torsion.m_rigidProxy].m_angularImpulse -= torsion.m_impulse;
}

// Lists the bodies of constraints, sorted by address.
void listBodies(const btTypedConstraint* const* constraints, std::size_t count, std::vector<const btRigidBody*>& bodies)
{
    bodies.clear();
    for (std::size_t k = 0; k < count; ++k)
        bodies.insert(bodies.end(), {&constraints[k]->getRigidBodyA(), &constraints[k]->getRigidBodyB()});
    std::sort(bodies.begin(), bodies.end(), std::less<const btRigidBody*>());
}

}  // namespace

void RigidProxies::noteBeforeSolve(const btCollisionObject& object)
{
    btRigidBody* body = movableBody(object);
    const btMultiBodyLinkCollider* link = linkOf(object);
    if (!body && !link) return;
    const std::lock_guard<std::mutex> lock(m_beforeMutex);
    if (link)
        m_links.noteBeforeSolve(*link->m_multiBody);
    else
        m_history.noteBeforeSolve(*body);
}

bool RigidProxies::isConstrained(const btRigidBody& body) const
{
    return body.getNumConstraintRefs() > 0 ||
           std::binary_search(m_constrained.begin(), m_constrained.end(), &body, std::less<const btRigidBody*>());
}

void RigidProxies::clear(RigidPhase phase, const RigidRewind* rewind, const btTypedConstraint* const* constraints,
                         std::size_t count)
{
    m_phase = phase;
    m_rewind = rewind;
    m_rigidProxies.clear();
    m_sources.clear();
    m_byObject.clear();
    m_links.clear();
    listBodies(constraints, count, m_constrained);
    if (rewind) listBodies(rewind->presentConstraints().data(), rewind->presentConstraints().size(), m_constrained);
}

int RigidProxies::indexOf(const btCollisionObject& object, double step)
{
    if (const int known = find(object); known >= 0) return known;
    const int index = static_cast<int>(m_rigidProxies.size());
    m_byObject.add(&object, m_sources.size());
    m_sources.push_back({});
    m_sources.back().m_object = &object;
    RigidProxy rigidProxy = immovable(object);
    const btMultiBodyLinkCollider* link = linkOf(object);
    if (link && canMove(*link))
        m_sources.back().m_now = m_links.add(index, *link, m_phase == RigidPhase::moved ? step : 0, rigidProxy);
    else if (link)
    {
        const LinkMotion led = motionOf(*link, m_linkVelocities);
        rigidProxy.m_linearVelocity = led.m_linear;
        rigidProxy.m_angularVelocity = led.m_angular;
    }
    if (const btRigidBody* body = movableBody(object))
    {
        const Mat3 factor = {{{body->getAngularFactor().x(), 0, 0},
                              {0, body->getAngularFactor().y(), 0},
                              {0, 0, body->getAngularFactor().z()}}};
        rigidProxy.m_inverseMass = body->getInvMass() * vec3(body->getLinearFactor());
        rigidProxy.m_inverseInertia = factor * mat3(body->getInvInertiaTensorWorld()) * factor;
        rigidProxy.m_center = vec3(body->getCenterOfMassPosition());
        rigidProxy.m_linearVelocity = vec3(body->getLinearVelocity());
        rigidProxy.m_angularVelocity = vec3(body->getAngularVelocity());
        if (m_phase == RigidPhase::moved)
        {
            rigidProxy.m_linearVelocity += step * vec3(body->getGravity());
            const LinkMotion support = m_history.supportOf(*body, step, rigidProxy, false);
            rigidProxy.m_linearVelocity += support.m_linear;
            rigidProxy.m_angularVelocity += support.m_angular;
        }
        else
        {
            m_history.takeBack(*body);
            rigidProxy.m_linearVelocity += step * body->getInvMass() * vec3(body->getTotalForce());
            rigidProxy.m_angularVelocity += step * (rigidProxy.m_inverseInertia * vec3(body->getTotalTorque()));
            if (const LinkMotion* byBullet = m_rewind ? m_rewind->motionByBullet(object) : nullptr)
            {
                rigidProxy.m_linearVelocity = byBullet->m_linear;
                rigidProxy.m_angularVelocity = byBullet->m_angular;
            }
        }
        m_sources.back().m_now = {rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity};
    }
    m_rigidProxies.push_back(rigidProxy);
    return index;
}

// Bullet resets the hit fraction of bodies that its own continuous collision detection has stopped. A body that was
// rewound remains so: otherwise it is seen one step ahead, so a change near a surface would skip a step, in which it
// may pass the surface.
int RigidProxies::indexForContact(const btCollisionObject& object, double step, const Body& soft)
{
    const bool isKnown = find(object) >= 0;
    const int index = indexOf(object, step);
    const RigidProxy& rigidProxy = m_rigidProxies[index];
    if (isKnown || m_phase != RigidPhase::moved || !rigidProxy.canMove() || object.getHitFraction() == 0) return index;
    const LinkMotion now = motionNow(index);
    const btRigidBody* body = movableBody(object);
    const double byGravity =
        body ? step * norm(vec3(body->getGravity())) : norm(rigidProxy.m_linearVelocity - now.m_linear);
    if (!m_history.wasRewound(object) && !isFastRelativeTo(soft, object, now, byGravity, step)) return index;
    rewind(index, step);
    m_history.noteRewound(object);
    return index;
}

int RigidProxies::indexForJoint(const btCollisionObject& object, double step)
{
    const bool isKnown = find(object) >= 0;
    const int index = indexOf(object, step);
    const btRigidBody* body = movableBody(object);
    const bool canRewind = body ? body->getNumConstraintRefs() == 0 : m_links.isFree(index);
    if (!isKnown && m_phase == RigidPhase::moved && canRewind && object.getHitFraction() != 0) rewind(index, step);
    return index;
}

int RigidProxies::indexBeside(const btCollisionObject& object, double step, int neighbour)
{
    const int index = indexOf(object, step);
    // Bullet's continuous collision detection did not stop it
    const bool asMoved = movableBody(object) && object.getHitFraction() != 0;
    if (!asMoved || !isRewound(neighbour) || isRewound(index)) return index;
    rewind(index, step);
    m_history.noteRewound(object);
    return index;
}

// Puts a rigid proxy back to the start of the step. Bullet's contacts are rows of the problem; its joints are known by
// the change that they made.
void RigidProxies::rewind(int index, double step)
{
    Source& source = m_sources[index];
    RigidProxy& rigidProxy = m_rigidProxies[index];
    const LinkMotion now = motionNow(index);
    rigidProxy.m_center -= step * now.m_linear;
    rigidProxy.m_linearVelocity = now.m_linear;
    const btRigidBody* body = movableBody(*source.m_object);
    if (!body || body->getNumConstraintRefs() == 0) rigidProxy.m_angularVelocity = now.m_angular;
    if (body)
    {
        if (body->getNumConstraintRefs() > 0)
        {
            source.m_held = m_history.doneByBullet(*body, step, rigidProxy).m_linear;
            rigidProxy.m_linearVelocity += m_history.supportOf(*body, step, rigidProxy, true).m_linear;
        }
        source.m_now = {rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity};
        const LinkMotion expected = m_history.takeExpected(*body);
        rigidProxy.m_linearVelocity -= expected.m_linear;
        rigidProxy.m_angularVelocity -= expected.m_angular;
    }
    m_links.setCenter(index, rigidProxy.m_center);
    source.m_rewound = true;
}

void RigidProxies::applyReactions(const ContactProblem& problem, double step, bool lasts)
{
    sumImpulses(problem, m_rigidProxies, m_sources);
    for (std::size_t k = 0; k < m_sources.size(); ++k)
    {
        Source& source = m_sources[k];
        const RigidProxy& rigidProxy = m_rigidProxies[k];
        const LinkMotion change = {rigidProxy.m_linearVelocity - source.m_now.m_linear,
                                   rigidProxy.m_angularVelocity - source.m_now.m_angular};
        if (!isBelow(kFastest, change.m_linear) || !isBelow(kFastest, change.m_angular) ||
            !isBelow(kFastest, rigidProxy.m_pushLinear) || !isBelow(kFastest, rigidProxy.m_pushAngular))
            continue;
        m_links.addImpulse(static_cast<int>(k), source.m_linearImpulse, source.m_angularImpulse);
        if (source.m_rewound)
        {
            m_rigidProxies[k].m_pushImpulse += source.m_linearImpulse;
            m_rigidProxies[k].m_pushAngularImpulse += source.m_angularImpulse;
        }
        btRigidBody* body = movableBody(*source.m_object);
        if (!body) continue;
        source.m_angularImpulse += rigidProxy.m_angularImpulse;
        const bool felt = isAny(source.m_linearImpulse, source.m_angularImpulse);
        const bool throughOthers = m_phase == RigidPhase::moved && body->isActive();
        if (felt || (throughOthers && isAny(change.m_linear, change.m_angular)))
        {
            if (m_phase == RigidPhase::moved) m_history.addToVelocity(*body, change, lasts);
            if (!body->isActive()) body->activate();  // Bullet's islands handle active bodies
        }
        Vec3 linear = rigidProxy.m_pushLinear, angular = rigidProxy.m_pushAngular;
        if (source.m_rewound)  // it moved with the old velocity instead of the new one
        {
            linear += heldBack(change.m_linear, source.m_held);
            angular += change.m_angular;
        }
        if (!isAny(linear, angular)) continue;
        btTransform pushed;
        btTransformUtil::integrateTransform(body->getCenterOfMassTransform(), bulletVector(linear),
                                            bulletVector(angular), btScalar(step), pushed);
        body->setCenterOfMassTransform(pushed);
    }
    m_links.apply(m_rigidProxies, step);
    if (m_phase == RigidPhase::moved) m_history.returnExpected();
}

LinkMotion RigidProxies::motionNow(int rigidProxy) const
{
    const btRigidBody* body = movableBody(object(rigidProxy));
    if (m_phase == RigidPhase::moved && body)
        return {vec3(body->getLinearVelocity()), vec3(body->getAngularVelocity())};
    if (isMovableLink(*this, rigidProxy)) return m_sources[rigidProxy].m_now;
    return {m_rigidProxies[rigidProxy].m_linearVelocity, m_rigidProxies[rigidProxy].m_angularVelocity};
}

}  // namespace bullet_fem
