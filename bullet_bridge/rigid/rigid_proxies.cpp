// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rigid_proxies.h"

#include <algorithm>

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

constexpr double kRounding = 1e-5;  // relative rounding error of velocity differences

Mat3 mat3(const btMatrix3x3& m)
{
    Mat3 result;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) result(i, j) = m[i][j];
    return result;
}

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

// Sets the motion of a multibody's link that impulses do not move. `scratch` grows with the number of links.
void setLinkVelocity(const btMultiBodyLinkCollider& link, std::vector<btVector3>& scratch, RigidProxy& rigidProxy)
{
    const std::size_t count = link.m_multiBody->getNumLinks() + 1, k = link.m_link + 1;
    if (scratch.size() < 2 * count) scratch.resize(2 * count);
    link.m_multiBody->compTreeLinkVelocities(&scratch[0], &scratch[count]);
    const btMatrix3x3& fromLink = link.getWorldTransform().getBasis();
    rigidProxy.m_angularVelocity = vec3(fromLink * scratch[k]);
    rigidProxy.m_linearVelocity = vec3(fromLink * scratch[count + k]);
}

// Removes from a velocity change its component against the direction in which a body is held.
Vec3 heldBack(const Vec3& change, const Vec3& holding)
{
    const double against = dot(change, holding);
    return against < 0 ? change - (against / dot(holding, holding)) * holding : change;
}

}  // namespace

btRigidBody* movableBody(const btCollisionObject& object)
{
    auto* body = const_cast<btRigidBody*>(btRigidBody::upcast(&object));
    return body && !body->isStaticOrKinematicObject() && body->getInvMass() > 0 ? body : nullptr;
}

const btMultiBodyLinkCollider* linkOf(const btCollisionObject& object)
{
    const btMultiBodyLinkCollider* link = btMultiBodyLinkCollider::upcast(&object);
    return link && link->m_multiBody && link->m_link < link->m_multiBody->getNumLinks() ? link : nullptr;
}

// Component by component through a volatile: GCC 12 otherwise vectorises and drops the conversion to single precision
// and back, so that no remainder would be left.
btVector3 addedExactly(const btVector3& velocity, const Vec3& change, Vec3& remainder)
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

int broadphaseId(const btCollisionObject& object)
{
    return object.getBroadphaseHandle() ? object.getBroadphaseHandle()->m_uniqueId : -1;
}

void RigidProxies::restore(const Memory& memory)
{
    m_remainders.assign(memory.m_remainders.begin(), memory.m_remainders.end());
    m_rewound.assign(memory.m_rewound.begin(), memory.m_rewound.end());
}

void RigidProxies::beginStep(double step)
{
    m_step = step;
    m_remainders.erase(
        std::remove_if(m_remainders.begin(), m_remainders.end(), [](const Remainder& r) { return !r.m_used; }),
        m_remainders.end());
    for (Remainder& r : m_remainders) r.m_used = false;
    m_before.clear();
    m_articulated.beginStep();
    m_lastRewound.swap(m_rewound);
    m_rewound.clear();
}

void RigidProxies::clear(RigidPhase phase)
{
    m_phase = phase;
    m_rigidProxies.clear();
    m_sources.clear();
    m_articulated.clear();
}

btRigidBody* RigidProxies::movableBody(int rigidProxy) const
{
    return bullet_fem::movableBody(*m_sources[rigidProxy].m_object);
}

int RigidProxies::indexOf(const btCollisionObject& object, double step)
{
    for (std::size_t k = 0; k < m_sources.size(); ++k)
        if (m_sources[k].m_object == &object) return static_cast<int>(k);
    m_sources.push_back({});
    m_sources.back().m_object = &object;
    m_sources.back().m_objectId = broadphaseId(object);
    RigidProxy rigidProxy = immovable(object);
    const btMultiBodyLinkCollider* link = linkOf(object);
    const int index = static_cast<int>(m_rigidProxies.size());
    if (link && ArticulatedBodies::canMove(*link))
        m_sources.back().m_now = m_phase == RigidPhase::moved ? m_articulated.add(index, *link, step, rigidProxy)
                                                              : m_articulated.addBeforeSolve(index, *link, rigidProxy);
    else if (link)
        setLinkVelocity(*link, m_linkVelocities, rigidProxy);
    if (const btRigidBody* body = bullet_fem::movableBody(object))
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
            const LinkMotion support = supportOf(*body, step, rigidProxy, false);
            rigidProxy.m_linearVelocity += support.m_linear;
            rigidProxy.m_angularVelocity += support.m_angular;
        }
        else
        {
            takeBack(object);
            rigidProxy.m_linearVelocity += step * body->getInvMass() * vec3(body->getTotalForce());
            rigidProxy.m_angularVelocity += step * (rigidProxy.m_inverseInertia * vec3(body->getTotalTorque()));
        }
        m_sources.back().m_now = {rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity};
    }
    m_rigidProxies.push_back(rigidProxy);
    return index;
}

// Velocity change by Bullet's contacts and joints in this step.
LinkMotion RigidProxies::doneByBullet(const btRigidBody& body, double step, const RigidProxy& rigidProxy) const
{
    const auto before =
        std::find_if(m_before.begin(), m_before.end(), [&](const Before& b) { return b.m_object == &body; });
    if (before == m_before.end()) return {};
    const Vec3 after = vec3(body.getLinearVelocity());
    const Vec3 forces = step * body.getInvMass() * vec3(body.getTotalForce());
    const Vec3 torques = step * (rigidProxy.m_inverseInertia * vec3(body.getTotalTorque()));
    LinkMotion done = {after - before->m_linear - forces,
                       vec3(body.getAngularVelocity()) - before->m_angular - torques};
    if (norm(done.m_linear) < kRounding * (norm(after) + norm(forces))) done.m_linear = {};
    return done;
}

// Predicts the support of a body in the next step: a body on a floor neither falls nor yields to a soft body's push. It
// is the change by Bullet's contacts and joints in this step, as far as that balances gravity and the last impulses of
// soft bodies; any further change, as of an impact, will not recur. A rewound body is at its place before that change.
LinkMotion RigidProxies::supportOf(const btRigidBody& body, double step, const RigidProxy& rigidProxy, bool rewound)
{
    const LinkMotion done = doneByBullet(body, step, rigidProxy);
    const auto part = [](const Vec3& whole, const Vec3& needed)
    {
        const double square = dot(whole, whole);
        return square > 0 ? std::clamp(dot(whole, needed) / square, 0.0, 1.0) * whole : Vec3();
    };
    const Remainder& memory = remainderOf(broadphaseId(body));
    const Vec3 gravity = rewound ? Vec3() : step * vec3(body.getGravity());
    return {part(done.m_linear, -(gravity + memory.m_linearGiven)), part(done.m_angular, -memory.m_angularGiven)};
}

// True if the relative motion is so fast that the body must be rewound. Speed that gravity adds in a step does not
// count, as resting bodies have it as well, except for small bodies that fall far by it. Bullet resets the hit fraction
// of bodies that its own continuous collision detection has stopped. A body that was rewound remains so: otherwise it
// is seen one step ahead, so a change near a surface would skip a step, in which it may pass the surface.
bool RigidProxies::mustRewind(int rigidProxy, double step, const Body& soft) const
{
    const btCollisionObject& object = *m_sources[rigidProxy].m_object;
    if (object.getHitFraction() == 0) return false;
    const int id = broadphaseId(object);
    if (std::find(m_lastRewound.begin(), m_lastRewound.end(), id) != m_lastRewound.end()) return true;
    const btTransform& present = object.getWorldTransform();
    const ShapeLeaf whole = {object.getCollisionShape(), {mat3(present.getBasis()), vec3(present.getOrigin())}, {}, {}};
    const LinkMotion now = motionNow(rigidProxy);
    const RigidMotion motion = {vec3(present.getOrigin()), now.m_linear, now.m_angular};
    const btRigidBody* body = movableBody(rigidProxy);
    const double byGravity =
        body ? step * norm(vec3(body->getGravity())) : norm(m_rigidProxies[rigidProxy].m_linearVelocity - now.m_linear);
    const double speed = fastestNode(soft, motion.m_linearVelocity), edge = soft.m_model->mesh().meanEdgeLength();
    const SweptShape swept(whole, motion, step);
    return isFast(swept, speed - 2 * byGravity, edge) || fallsFar(swept, byGravity / step, edge);
}

int RigidProxies::indexForContact(const btCollisionObject& object, double step, const Body& soft)
{
    const std::size_t known = m_sources.size();
    const int index = indexOf(object, step);
    if (m_sources.size() == known || m_phase != RigidPhase::moved || !m_rigidProxies[index].canMove() ||
        !mustRewind(index, step, soft))
        return index;
    rewind(index, step);
    m_rewound.push_back(m_sources[index].m_objectId);
    return index;
}

int RigidProxies::indexForJoint(const btCollisionObject& object, double step)
{
    const std::size_t known = m_sources.size();
    const int index = indexOf(object, step);
    const btRigidBody* body = movableBody(index);
    const bool canRewind = body && body->getNumConstraintRefs() == 0 && object.getHitFraction() != 0;
    if (m_sources.size() > known && m_phase == RigidPhase::moved && canRewind) rewind(index, step);
    return index;
}

bool RigidProxies::holdsRewound() const
{
    return std::any_of(m_sources.begin(), m_sources.end(), [](const Source& source) { return source.m_rewound; });
}

int RigidProxies::indexBeside(const btCollisionObject& object, double step, int neighbour)
{
    const int index = indexOf(object, step);
    // Bullet's continuous collision detection did not stop it
    const bool asMoved = movableBody(index) && object.getHitFraction() != 0;
    if (!asMoved || !isRewound(neighbour) || isRewound(index)) return index;
    rewind(index, step);
    m_rewound.push_back(m_sources[index].m_objectId);
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
    const btRigidBody* body = bullet_fem::movableBody(*source.m_object);
    if (!body || body->getNumConstraintRefs() == 0) rigidProxy.m_angularVelocity = now.m_angular;
    if (body)
    {
        if (body->getNumConstraintRefs() > 0)
        {
            source.m_held = doneByBullet(*body, step, rigidProxy).m_linear;
            rigidProxy.m_linearVelocity += supportOf(*body, step, rigidProxy, true).m_linear;
        }
        source.m_now = {rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity};
        const LinkMotion expected = takeExpected(*body);
        rigidProxy.m_linearVelocity -= expected.m_linear;
        rigidProxy.m_angularVelocity -= expected.m_angular;
    }
    m_articulated.setCenter(index, rigidProxy.m_center);
    source.m_rewound = true;
}

RigidProxies::Remainder& RigidProxies::remainderOf(int objectId)
{
    for (Remainder& r : m_remainders)
        if (r.m_objectId == objectId) return r;
    m_remainders.push_back({objectId, {}, {}, true, {}, {}, {}, {}});
    return m_remainders.back();
}

void RigidProxies::addReaction(int rigidProxy, const Vec3& impulse, const Vec3& arm)
{
    if (!isOurs(rigidProxy)) return;
    m_sources[rigidProxy].m_linearImpulse += impulse;
    m_sources[rigidProxy].m_angularImpulse += cross(arm, impulse);
}

void RigidProxies::addJointReaction(const JointEnd& end, const Vec3& impulse)
{
    if (!isOurs(end.m_rigidProxy)) return;
    if (end.m_angular)
        m_sources[end.m_rigidProxy].m_angularImpulse += impulse;
    else
        addReaction(end.m_rigidProxy, impulse, end.m_point - m_rigidProxies[end.m_rigidProxy].m_center);
}

void RigidProxies::applyReactions(const ContactProblem& problem, double step, bool lasts)
{
    for (const ContactPoint& contact : problem.m_contacts)
        addReaction(contact.m_rigidProxy, -contact.m_impulse, contact.m_arm);
    for (const Joint& joint : problem.m_joints)
    {
        addJointReaction(joint.m_a, joint.m_impulse);
        addJointReaction(joint.m_b, -joint.m_impulse);
    }
    for (const TorsionalFriction& torsion : problem.m_torsions)
        m_sources[torsion.m_rigidProxy].m_angularImpulse -= torsion.m_impulse;
    for (std::size_t k = 0; k < m_sources.size(); ++k)
    {
        Source& source = m_sources[k];
        const RigidProxy& rigidProxy = m_rigidProxies[k];
        const LinkMotion change = {rigidProxy.m_linearVelocity - source.m_now.m_linear,
                                   rigidProxy.m_angularVelocity - source.m_now.m_angular};
        if (!isBelow(kFastest, change.m_linear) || !isBelow(kFastest, change.m_angular) ||
            !isBelow(kFastest, rigidProxy.m_pushLinear) || !isBelow(kFastest, rigidProxy.m_pushAngular))
            continue;
        m_articulated.addImpulse(static_cast<int>(k), source.m_linearImpulse, source.m_angularImpulse);
        if (source.m_rewound)
        {
            m_rigidProxies[k].m_pushImpulse += source.m_linearImpulse;
            m_rigidProxies[k].m_pushAngularImpulse += source.m_angularImpulse;
        }
        btRigidBody* body = bullet_fem::movableBody(*source.m_object);
        if (!body) continue;
        source.m_angularImpulse += rigidProxy.m_angularImpulse;
        const bool felt = isAny(source.m_linearImpulse, source.m_angularImpulse);
        const bool throughOthers = m_phase == RigidPhase::moved && body->isActive();
        if (felt || (throughOthers && isAny(change.m_linear, change.m_angular)))
        {
            if (m_phase == RigidPhase::moved) addToVelocity(*body, source, change, lasts);
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
    m_articulated.apply(m_rigidProxies, step);
    if (m_phase == RigidPhase::moved) returnExpected();
}

LinkMotion RigidProxies::motionNow(int rigidProxy) const
{
    const btRigidBody* body = movableBody(rigidProxy);
    if (m_phase == RigidPhase::moved && body)
        return {vec3(body->getLinearVelocity()), vec3(body->getAngularVelocity())};
    if (isMovableLink(rigidProxy)) return m_sources[rigidProxy].m_now;
    return {m_rigidProxies[rigidProxy].m_linearVelocity, m_rigidProxies[rigidProxy].m_angularVelocity};
}

}  // namespace bullet_fem
