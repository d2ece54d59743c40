// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/snapshot/btFemObjectSnapshot.h"

#include <algorithm>
#include <cmath>

#include "BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h"
#include "LinearMath/btMotionState.h"
#include "fem/common/message.h"
#include "plugin/snapshot/btFemFinite.h"
#include "plugin/snapshot/btFemPrivateState.h"

using namespace bullet_fem;

namespace
{

btFemObjectSnapshot snapshotOf(const btCollisionObject& object)
{
    btFemObjectSnapshot s;
    if (object.getBroadphaseHandle()) s.m_id = object.getBroadphaseHandle()->m_uniqueId;
    s.m_type = object.getInternalType();
    s.m_shape = object.getCollisionShape() ? object.getCollisionShape()->getShapeType() : -1;
    s.m_place = object.getWorldTransform();
    s.m_interpolated = object.getInterpolationWorldTransform();
    s.m_interpolatedVelocity = object.getInterpolationLinearVelocity();
    s.m_interpolatedSpin = object.getInterpolationAngularVelocity();
    s.m_activation = object.getActivationState();
    s.m_deactivationTime = object.getDeactivationTime();
    s.m_hitFraction = object.getHitFraction();
    if (const btRigidBody* body = btRigidBody::upcast(&object))
    {
        s.m_velocity = body->getLinearVelocity();
        s.m_spin = body->getAngularVelocity();
        s.m_force = body->getTotalForce();
        s.m_torque = body->getTotalTorque();
    }
    return s;
}

btFemJointSnapshot snapshotOf(btTypedConstraint& joint)
{
    return {joint.getConstraintType(), joint.isEnabled(), {joint.internalGetAppliedImpulse()}};
}

void checkOne(const btFemObjectSnapshot& s, const btCollisionObject& object)
{
    const btFemObjectSnapshot now = snapshotOf(object);
    if (now.m_id != s.m_id || now.m_type != s.m_type || now.m_shape != s.m_shape)
        reject("the object with broad phase id ", s.m_id, " is another: the world's has id ", now.m_id,
               "; build the world in the order of the one that was saved");
    if (!btFemFinite::are(s.m_place, s.m_interpolated, s.m_interpolatedVelocity, s.m_interpolatedSpin,
                          s.m_deactivationTime, s.m_hitFraction, s.m_velocity, s.m_spin, s.m_force, s.m_torque))
        reject("the object with broad phase id ", s.m_id, " has numbers that are not finite");
    if (s.m_activation < ACTIVE_TAG || s.m_activation > FIXED_BASE_MULTI_BODY)
        reject("the object with broad phase id ", s.m_id, " has activation state ", s.m_activation);
}

void restoreOne(const btFemObjectSnapshot& s, btCollisionObject& object)
{
    btRigidBody* body = btRigidBody::upcast(&object);
    object.setWorldTransform(s.m_place);
    if (body)
    {
        body->setLinearVelocity(s.m_velocity);
        body->setAngularVelocity(s.m_spin);
        body->*memberOf(btFemTotalForce{}) = s.m_force;
        body->*memberOf(btFemTotalTorque{}) = s.m_torque;
        body->updateInertiaTensor();
        if (body->getMotionState()) body->getMotionState()->setWorldTransform(s.m_place);
    }
    object.setInterpolationWorldTransform(s.m_interpolated);
    object.setInterpolationLinearVelocity(s.m_interpolatedVelocity);
    object.setInterpolationAngularVelocity(s.m_interpolatedSpin);
    object.forceActivationState(s.m_activation);
    object.setDeactivationTime(s.m_deactivationTime);
    object.setHitFraction(s.m_hitFraction);
}

void checkJoint(const btFemJointSnapshot& s, int type, std::size_t rows)
{
    if (s.m_type != type || s.m_impulses.size() != rows)
        reject("a joint is of type ", type, " with ", rows, " impulses, and the state's of type ", s.m_type, " with ",
               s.m_impulses.size());
    for (const btScalar impulse : s.m_impulses)
        if (!std::isfinite(impulse)) reject("the impulse of a joint is ", impulse);
}

template <class T>
void checkCount(const std::vector<T>& saved, int count, const char* name)
{
    if (int(saved.size()) != count) reject("it has ", saved.size(), " ", name, ", and the world ", count);
}

void checkAll(const std::vector<btFemJointSnapshot>& saved, btDiscreteDynamicsWorld& world)
{
    checkCount(saved, world.getNumConstraints(), "joints");
    for (int k = 0; k < world.getNumConstraints(); ++k)
        checkJoint(saved[std::size_t(k)], world.getConstraint(k)->getConstraintType(), 1);
}

btSequentialImpulseConstraintSolver* seededSolver(btDiscreteDynamicsWorld& world)
{
    return dynamic_cast<btSequentialImpulseConstraintSolver*>(world.getConstraintSolver());
}

}  // namespace

btFemObjectsSnapshot objectsSnapshotOf(btDiscreteDynamicsWorld& world)
{
    btFemObjectsSnapshot s;
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int k = 0; k < objects.size(); ++k) s.m_objects.push_back(snapshotOf(*objects[k]));
    for (int k = 0; k < world.getNumConstraints(); ++k) s.m_joints.push_back(snapshotOf(*world.getConstraint(k)));
    appendMultiBodies(s, world);
    if (const auto* solver = seededSolver(world)) s.m_seeds.push_back(unsigned(solver->getRandSeed()));
    s.m_localTime = world.*memberOf(btFemWorldTime{});
    return s;
}

void check(const btFemObjectsSnapshot& s, btDiscreteDynamicsWorld& world)
{
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    checkCount(s.m_objects, objects.size(), "objects");
    for (int k = 0; k < objects.size(); ++k) checkOne(s.m_objects[std::size_t(k)], *objects[k]);
    checkAll(s.m_joints, world);
    checkMultiBodies(s, world);
    checkCount(s.m_seeds, seededSolver(world) ? 1 : 0, "seeds of its rigid solver");
    if (!std::isfinite(s.m_localTime)) reject("the time since its last fixed step is ", s.m_localTime, " s");
}

void restore(const btFemObjectsSnapshot& s, btDiscreteDynamicsWorld& world)
{
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int k = 0; k < objects.size(); ++k) restoreOne(s.m_objects[std::size_t(k)], *objects[k]);
    for (int k = 0; k < world.getNumConstraints(); ++k)
    {
        world.getConstraint(k)->setEnabled(s.m_joints[std::size_t(k)].m_enabled);
        world.getConstraint(k)->internalSetAppliedImpulse(s.m_joints[std::size_t(k)].m_impulses[0]);
    }
    restoreMultiBodies(s, world);
    if (auto* solver = seededSolver(world)) solver->setRandSeed(s.m_seeds[0]);
    world.*memberOf(btFemWorldTime{}) = s.m_localTime;
    world.synchronizeMotionStates();
}
