// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rigid_rewind.h"

#include <algorithm>
#include <functional>

#include "BulletCollision/BroadphaseCollision/btDispatcher.h"
#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "BulletDynamics/Dynamics/btDynamicsWorld.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btTransformUtil.h"
#include "bullet_bridge/rigid/broadphase_objects.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

// Share of the speeds involved that an unexplained velocity change may have by rounding; a constraint that no body
// refers to changes velocities by more in all but a few steps [-].
constexpr btScalar kUnexplained = btScalar(1e-3);

// Share of a step's motion, and of the distance from the origin, by which single precision displaces a body [-].
constexpr btScalar kMotionRounding = btScalar(1e-3), kPlaceRounding = btScalar(1e-5);

// The vector; 0 if it is not finite, as after bad rows of constraints in Bullet's own solver.
btVector3 finite(const btVector3& v)
{
    return isFinite(vec3(v)) ? v : btVector3(0, 0, 0);
}

}  // namespace

RigidRewind::State RigidRewind::stateOf(const btRigidBody& body)
{
    return {body.getWorldTransform(), body.getLinearVelocity(), body.getAngularVelocity(), body.getTotalForce(),
            body.getTotalTorque()};
}

// Forces are the totals: the body's factors are applied already.
void RigidRewind::setState(btRigidBody& body, const State& state)
{
    body.setLinearVelocity(state.m_linear);
    body.setAngularVelocity(state.m_angular);
    body.setCenterOfMassTransform(state.m_transform);
    const btVector3 linear = body.getLinearFactor(), angular = body.getAngularFactor();
    body.setLinearFactor({1, 1, 1});
    body.setAngularFactor({1, 1, 1});
    body.clearForces();
    body.applyCentralForce(state.m_force);
    body.applyTorque(state.m_torque);
    body.setLinearFactor(linear);
    body.setAngularFactor(angular);
}

void RigidRewind::note(const btSoftBody& soft)
{
    forget();
    if (!soft.m_worldInfo || !soft.m_worldInfo->m_broadphase || !soft.m_worldInfo->m_dispatcher) return;
    m_broadphase = soft.m_worldInfo->m_broadphase;
    m_dispatcher = soft.m_worldInfo->m_dispatcher;
    const auto add = [this](btCollisionObject* object)
    {
        btRigidBody* body = movableBody(*object);
        if (!body) return;
        Noted noted;
        noted.m_body = body;
        noted.m_id = broadphaseId(*body);
        noted.m_before = stateOf(*body);
        m_bodies.push_back(noted);
    };
    forEachObject(*m_broadphase, add);
    std::sort(m_bodies.begin(), m_bodies.end(), [](const Noted& a, const Noted& b) { return a.m_id < b.m_id; });
    indexBodies();
    noteConstraints();
    m_impulses.note(*m_dispatcher);
}

void RigidRewind::forget()
{
    m_broadphase = nullptr;
    m_dispatcher = nullptr;
    m_world = nullptr;
    m_bodies.clear();
    m_byBody.clear();
    m_known.clear();
    m_impulses.forget();
    m_back.clear();
}

// Visits every constraint at its first noted body.
void RigidRewind::noteConstraints()
{
    for (std::size_t k = 0; k < m_bodies.size(); ++k)
        for (int c = 0; c < m_bodies[k].m_body->getNumConstraintRefs(); ++c)
        {
            btTypedConstraint* constraint = m_bodies[k].m_body->getConstraintRef(c);
            const int a = indexOf(&constraint->getRigidBodyA()), b = indexOf(&constraint->getRigidBodyB());
            if (static_cast<int>(k) != (a >= 0 && b >= 0 ? std::min(a, b) : std::max(a, b))) continue;
            noteConstraint(*constraint);
        }
    giveFeedback();
}

void RigidRewind::noteConstraint(btTypedConstraint& constraint)
{
    m_known.emplace_back();
    m_known.back().m_constraint = &constraint;
    m_known.back().m_isEnabled = constraint.isEnabled();
}

// Call when m_known has grown, as its entries may have moved.
void RigidRewind::giveFeedback()
{
    for (Constraint& known : m_known)
    {
        const btJointFeedback* present = known.m_constraint->getJointFeedback();
        if (present && present != known.m_given) continue;
        known.m_given = &known.m_feedback;
        known.m_constraint->setJointFeedback(known.m_given);
    }
}

void RigidRewind::listReferred()
{
    m_presentConstraints.clear();
    for (const Noted& noted : m_bodies)
        for (int c = 0; c < noted.m_body->getNumConstraintRefs(); ++c)
            m_presentConstraints.push_back(noted.m_body->getConstraintRef(c));
    std::sort(m_presentConstraints.begin(), m_presentConstraints.end(), std::less<const btTypedConstraint*>());
}

bool RigidRewind::isPresent(const btTypedConstraint* constraint) const
{
    return std::binary_search(m_presentConstraints.begin(), m_presentConstraints.end(), constraint,
                              std::less<const btTypedConstraint*>());
}

void RigidRewind::noteWorld(btDynamicsWorld& world)
{
    if (!m_broadphase) return;
    m_world = &world;
    listReferred();
    for (int c = 0; c < world.getNumConstraints(); ++c)
    {
        btTypedConstraint& constraint = *world.getConstraint(c);
        const bool holds = indexOf(&constraint.getRigidBodyA()) >= 0 || indexOf(&constraint.getRigidBodyB()) >= 0;
        if (holds && !isPresent(&constraint)) noteConstraint(constraint);
    }
    giveFeedback();
}

bool RigidRewind::begin(double step)
{
    m_step = step;
    if (!m_broadphase) return false;
    dropRemoved();
    for (std::size_t k = 0; k < m_bodies.size(); ++k)
    {
        Noted& noted = m_bodies[k];
        const btRigidBody& body = *noted.m_body;
        noted.m_after = stateOf(body);
        noted.m_parent = static_cast<int>(k);
        noted.m_explained.setZero();
        noted.m_explainedParts = noted.m_pushed = 0;
        noted.m_isMoved = body.isActive();
        noted.m_linearByCallbacks = finite(body.getLinearVelocity() - body.getInterpolationLinearVelocity());
        noted.m_angularByCallbacks = finite(body.getAngularVelocity() - body.getInterpolationAngularVelocity());
        noted.m_byBullet = {vec3(finite(body.getInterpolationLinearVelocity())),
                            vec3(finite(body.getInterpolationAngularVelocity()))};
    }
    readConstraints();
    readManifolds();
    for (Noted& noted : m_bodies) checkBody(noted);
    for (std::size_t k = 0; k < m_bodies.size(); ++k)
        if (m_bodies[k].m_isBad) m_bodies[root(static_cast<int>(k))].m_isBad = true;
    return true;
}

bool RigidRewind::holds(const btCollisionObject* object) const
{
    return std::binary_search(m_present.begin(), m_present.end(), object, std::less<const btCollisionObject*>());
}

// A callback may have removed bodies, and deleted them.
void RigidRewind::dropRemoved()
{
    m_present.clear();
    forEachObject(*m_broadphase, [this](btCollisionObject* object) { m_present.push_back(object); });
    std::sort(m_present.begin(), m_present.end(), std::less<const btCollisionObject*>());
    const auto isGone = [this](const Noted& noted) { return !holds(noted.m_body); };
    const auto end = std::remove_if(m_bodies.begin(), m_bodies.end(), isGone);
    if (end == m_bodies.end()) return;
    m_bodies.erase(end, m_bodies.end());
    indexBodies();
}

void RigidRewind::indexBodies()
{
    m_byBody.assign(m_bodies.size(), [this](std::size_t k) { return m_bodies[k].m_body; });
}

// A callback may have removed constraints, and deleted them: those that the world has or present bodies refer to are
// present, as Bullet's worlds remove the references with them.
void RigidRewind::readConstraints()
{
    listReferred();
    for (int c = 0; m_world && c < m_world->getNumConstraints(); ++c)
        m_presentConstraints.push_back(m_world->getConstraint(c));
    std::sort(m_presentConstraints.begin(), m_presentConstraints.end(), std::less<const btTypedConstraint*>());
    const auto isGone = [this](const Constraint& known) { return !isPresent(known.m_constraint); };
    m_known.erase(std::remove_if(m_known.begin(), m_known.end(), isGone), m_known.end());
    for (Constraint& known : m_known)
    {
        btTypedConstraint& constraint = *known.m_constraint;
        const bool isOwn = known.m_given && constraint.getJointFeedback() == known.m_given;
        const btJointFeedback* feedback = isOwn ? &known.m_feedback : constraint.getJointFeedback();
        const int a = indexOf(&constraint.getRigidBodyA()), b = indexOf(&constraint.getRigidBodyB());
        if (a >= 0 && b >= 0) join(a, b);
        if (feedback && known.m_isEnabled)
        {
            if (a >= 0) explain(m_bodies[a], feedback->m_appliedForceBodyA * btScalar(m_step));
            if (b >= 0) explain(m_bodies[b], feedback->m_appliedForceBodyB * btScalar(m_step));
        }
        if (isOwn) constraint.setJointFeedback(nullptr);
    }
}

void RigidRewind::readManifolds()
{
    m_allManifolds.clear();
    for (int k = 0; k < m_dispatcher->getNumManifolds(); ++k)
    {
        btPersistentManifold* manifold = m_dispatcher->getManifoldByIndexInternal(k);
        const btCollisionObject &first = *manifold->getBody0(), &second = *manifold->getBody1();
        if (manifold->getNumContacts() == 0 || !hasRigidContacts(first) || !hasRigidContacts(second)) continue;
        const int a = indexOf(&first), b = indexOf(&second);
        if (a < 0 && b < 0) continue;
        m_allManifolds.push_back(manifold);
        if (a >= 0 && b >= 0) join(a, b);
        for (const int side : {a, b})
            if (side >= 0 && (btMultiBodyLinkCollider::upcast(&first) || btMultiBodyLinkCollider::upcast(&second)))
                m_bodies[side].m_isBad = true;
        for (int p = 0; p < manifold->getNumContacts(); ++p)
        {
            const btManifoldPoint& point = manifold->getContactPoint(p);
            const btVector3 impulse = point.m_appliedImpulse * point.m_normalWorldOnB + frictionOf(point);
            if (a >= 0) explain(m_bodies[a], impulse);
            if (b >= 0) explain(m_bodies[b], -impulse);
            for (const int side : {a, b})
                if (side >= 0) m_bodies[side].m_pushed = btMax(m_bodies[side].m_pushed, -point.getDistance());
        }
    }
    std::sort(m_allManifolds.begin(), m_allManifolds.end(),
              [](const btPersistentManifold* a, const btPersistentManifold* b) { return orderOf(*a) < orderOf(*b); });
}

void RigidRewind::explain(Noted& noted, const btVector3& impulse)
{
    noted.m_explained += impulse;
    noted.m_explainedParts += impulse.length();
}

void RigidRewind::checkBody(Noted& noted) const
{
    const btRigidBody& body = *noted.m_body;
    const btScalar h = btScalar(m_step);
    const btVector3 after = noted.m_after.m_linear - noted.m_linearByCallbacks;
    const btVector3 forces = h * body.getInvMass() * noted.m_before.m_force;
    const btVector3 explained = body.getInvMass() * body.getLinearFactor() * noted.m_explained;
    const btVector3 unexplained = after - noted.m_before.m_linear - forces - explained;
    const btScalar speeds = after.length() + noted.m_before.m_linear.length() + forces.length() +
                            body.getInvMass() * noted.m_explainedParts;
    btTransform expected;
    btTransformUtil::integrateTransform(noted.m_before.m_transform, after, body.getInterpolationAngularVelocity(), h,
                                        expected);
    const btVector3 to = noted.m_after.m_transform.getOrigin();
    const btScalar off = (to - expected.getOrigin()).length();
    const btScalar rounding = noted.m_pushed + kMotionRounding * h * after.length() + kPlaceRounding * to.length();
    const bool isStopped = body.getHitFraction() == 0;
    if (!noted.m_isMoved) return;
    if (unexplained.length() > kUnexplained * speeds || (off > rounding && !isStopped)) noted.m_isBad = true;
}

int RigidRewind::root(int k)
{
    while (m_bodies[k].m_parent != k) k = m_bodies[k].m_parent = m_bodies[m_bodies[k].m_parent].m_parent;
    return k;
}

void RigidRewind::join(int a, int b)
{
    a = root(a);
    b = root(b);
    m_bodies[std::max(a, b)].m_parent = std::min(a, b);
}

bool RigidRewind::rewind(const btCollisionObject& object)
{
    const int k = indexOf(&object);
    if (k < 0) return false;
    const int island = root(k);
    if (m_bodies[island].m_isBad) return false;
    if (m_bodies[island].m_isBack) return true;
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        if (root(static_cast<int>(i)) != island) continue;
        m_bodies[i].m_isBack = true;
        if (m_bodies[i].m_isMoved) setState(*m_bodies[i].m_body, m_bodies[i].m_before);
    }
    return true;
}

void RigidRewind::putForward()
{
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        Noted& noted = m_bodies[i];
        if (!noted.m_isBack || m_keeps[root(static_cast<int>(i))]) continue;
        noted.m_isBack = false;
        if (noted.m_isMoved) setState(*noted.m_body, noted.m_after);
    }
    listIsland();
}

void RigidRewind::listIsland()
{
    m_back.clear();
    m_manifolds.clear();
    m_constraints.clear();
    for (const Noted& noted : m_bodies)
        if (noted.m_isBack) m_back.push_back(noted.m_body);
    const auto isBack = [this](const btCollisionObject* object)
    {
        const int k = indexOf(object);
        return k >= 0 && m_bodies[k].m_isBack;
    };
    for (btPersistentManifold* manifold : m_allManifolds)
        if (isBack(manifold->getBody0()) || isBack(manifold->getBody1())) m_manifolds.push_back(manifold);
    m_impulses.set(m_manifolds);
    for (const Constraint& known : m_known)
    {
        btTypedConstraint& constraint = *known.m_constraint;
        if (!known.m_isEnabled || !(isBack(&constraint.getRigidBodyA()) || isBack(&constraint.getRigidBodyB())))
            continue;
        constraint.setEnabled(true);  // Bullet may have broken it, which soft bodies would have spared
        m_constraints.push_back(&constraint);
    }
}

void RigidRewind::move()
{
    m_impulses.finish(m_manifolds);
    for (std::size_t k = 0; k < m_bodies.size(); ++k)
        if (m_bodies[k].m_isBack && m_bodies[k].m_body->isActive())
            m_bodies[root(static_cast<int>(k))].m_isWoken = true;
    for (std::size_t k = 0; k < m_bodies.size(); ++k)
    {
        const Noted& noted = m_bodies[k];
        if (!noted.m_isBack) continue;
        btRigidBody& body = *noted.m_body;
        if (!m_bodies[root(static_cast<int>(k))].m_isWoken)
        {
            setState(body, noted.m_after);
            continue;
        }
        btTransform moved = body.getCenterOfMassTransform();
        if (body.getHitFraction() == 0)
            moved = noted.m_after.m_transform;  // Bullet's continuous collision detection has stopped it
        else
            body.predictIntegratedTransform(btScalar(m_step), moved);
        State after = noted.m_after;
        after.m_transform = moved;
        after.m_linear = body.getLinearVelocity();
        after.m_angular = body.getAngularVelocity();
        setState(body, after);
        body.setLinearVelocity(after.m_linear + noted.m_linearByCallbacks);
        body.setAngularVelocity(after.m_angular + noted.m_angularByCallbacks);
    }
}

}  // namespace bullet_fem
