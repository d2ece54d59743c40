// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>

#include "BulletDynamics/Featherstone/btMultiBodyConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "fem/common/message.h"
#include "plugin/snapshot/btFemFinite.h"
#include "plugin/snapshot/btFemObjectSnapshot.h"
#include "plugin/snapshot/btFemPrivateState.h"

using namespace bullet_fem;

namespace
{

std::array<btScalar, 4> numbersOf(const btQuaternion& q)
{
    return {q.x(), q.y(), q.z(), q.w()};
}

btQuaternion quaternionOf(const std::array<btScalar, 4>& q)
{
    return {q[0], q[1], q[2], q[3]};
}

// Bullet leaves interpolated positions undefined until the first step that a joint takes.
btFemLinkSnapshot snapshotOf(const btMultibodyLink& link)
{
    btFemLinkSnapshot s;
    std::copy_n(link.m_jointPos, 7, s.m_position.begin());
    s.m_interpolatedPosition = s.m_position;
    for (int k = 0; k < link.m_posVarCount; ++k)
        if (btFemFinite::are(link.m_jointPos_interpolate[k]))
            s.m_interpolatedPosition[k] = link.m_jointPos_interpolate[k];
    std::copy_n(link.m_jointTorque, 6, s.m_jointForce.begin());
    s.m_force = link.m_appliedForce;
    s.m_torque = link.m_appliedTorque;
    s.m_place = link.m_cachedWorldTransform;
    return s;
}

btFemMultiBodySnapshot snapshotOf(btMultiBody& body)
{
    btFemMultiBodySnapshot s;
    s.m_position = body.getBasePos();
    s.m_interpolatedPosition = body.getInterpolateBasePos();
    s.m_rotation = numbersOf(body.getWorldToBaseRot());
    s.m_interpolatedRotation = numbersOf(body.getInterpolateWorldToBaseRot());
    s.m_force = body.*memberOf(btFemLinksBaseForce{});
    s.m_torque = body.*memberOf(btFemLinksBaseTorque{});
    const btAlignedObjectArray<btScalar>& reals = body.*memberOf(btFemLinksReals{});
    for (int k = 0; k < reals.size(); ++k) s.m_reals.push_back(reals[k]);
    s.m_awake = body.isAwake();
    s.m_sleepTimer = body.*memberOf(btFemLinksSleepTimer{});
    for (int k = 0; k < body.getNumLinks(); ++k) s.m_links.push_back(snapshotOf(body.getLink(k)));
    return s;
}

void checkOne(const btFemMultiBodySnapshot& s, btMultiBody& body)
{
    const btAlignedObjectArray<btScalar>& reals = body.*memberOf(btFemLinksReals{});
    if (int(s.m_links.size()) != body.getNumLinks() || int(s.m_reals.size()) != reals.size())
        reject("a multibody has ", body.getNumLinks(), " links, and the state's ", s.m_links.size(),
               ", or its joints are others");
    bool finite = btFemFinite::are(s.m_position, s.m_interpolatedPosition, s.m_rotation, s.m_interpolatedRotation,
                                   s.m_force, s.m_torque, s.m_reals, s.m_sleepTimer);
    for (const btFemLinkSnapshot& link : s.m_links)
        finite = finite && btFemFinite::are(link.m_position, link.m_interpolatedPosition, link.m_jointForce,
                                            link.m_force, link.m_torque, link.m_place);
    if (!finite) reject("a multibody has numbers that are not finite");
}

void restoreOne(const btFemLinkSnapshot& s, btMultibodyLink& link)
{
    std::copy_n(s.m_position.begin(), 7, link.m_jointPos);
    std::copy_n(s.m_interpolatedPosition.begin(), 7, link.m_jointPos_interpolate);
    std::copy_n(s.m_jointForce.begin(), 6, link.m_jointTorque);
    link.m_appliedForce = s.m_force;
    link.m_appliedTorque = s.m_torque;
    link.m_cachedWorldTransform = s.m_place;
    link.updateCacheMultiDof();
    link.updateInterpolationCacheMultiDof();
}

void restoreOne(const btFemMultiBodySnapshot& s, btMultiBody& body)
{
    body.setBasePos(s.m_position);
    body.setInterpolateBasePos(s.m_interpolatedPosition);
    body.*memberOf(btFemLinksBaseQuat{}) = quaternionOf(s.m_rotation);
    body.*memberOf(btFemLinksInterpolatedQuat{}) = quaternionOf(s.m_interpolatedRotation);
    body.*memberOf(btFemLinksBaseForce{}) = s.m_force;
    body.*memberOf(btFemLinksBaseTorque{}) = s.m_torque;
    std::copy(s.m_reals.begin(), s.m_reals.end(), &(body.*memberOf(btFemLinksReals{}))[0]);
    body.*memberOf(btFemLinksAwake{}) = s.m_awake;
    body.*memberOf(btFemLinksSleepTimer{}) = s.m_sleepTimer;
    for (std::size_t k = 0; k < s.m_links.size(); ++k) restoreOne(s.m_links[k], body.getLink(int(k)));
}

btMultiBodyDynamicsWorld* multiBodyWorld(btDiscreteDynamicsWorld& world)
{
    return dynamic_cast<btMultiBodyDynamicsWorld*>(&world);
}

int rowsOf(btMultiBodyConstraint& joint)
{
    joint.finalizeMultiDof();  // otherwise it has no memory for impulses before the first step
    return joint.getNumRows();
}

}  // namespace

void appendMultiBodies(btFemObjectsSnapshot& s, btDiscreteDynamicsWorld& world)
{
    btMultiBodyDynamicsWorld* multi = multiBodyWorld(world);
    if (!multi) return;
    for (int k = 0; k < multi->getNumMultibodies(); ++k) s.m_multiBodies.push_back(snapshotOf(*multi->getMultiBody(k)));
    for (int k = 0; k < multi->getNumMultiBodyConstraints(); ++k)
    {
        btMultiBodyConstraint& joint = *multi->getMultiBodyConstraint(k);
        btFemJointSnapshot saved;
        saved.m_type = joint.getConstraintType();
        for (int row = 0; row < rowsOf(joint); ++row) saved.m_impulses.push_back(joint.getAppliedImpulse(row));
        s.m_linkJoints.push_back(saved);
    }
}

void checkMultiBodies(const btFemObjectsSnapshot& s, btDiscreteDynamicsWorld& world)
{
    btMultiBodyDynamicsWorld* multi = multiBodyWorld(world);
    const int bodies = multi ? multi->getNumMultibodies() : 0, joints = multi ? multi->getNumMultiBodyConstraints() : 0;
    if (int(s.m_multiBodies.size()) != bodies || int(s.m_linkJoints.size()) != joints)
        reject("it has ", s.m_multiBodies.size(), " multibodies with ", s.m_linkJoints.size(),
               " constraints, and the world ", bodies, " with ", joints);
    for (int k = 0; k < bodies; ++k) checkOne(s.m_multiBodies[std::size_t(k)], *multi->getMultiBody(k));
    for (int k = 0; k < joints; ++k)
    {
        btMultiBodyConstraint& joint = *multi->getMultiBodyConstraint(k);
        const btFemJointSnapshot& saved = s.m_linkJoints[std::size_t(k)];
        if (saved.m_type != joint.getConstraintType() || int(saved.m_impulses.size()) != rowsOf(joint) ||
            !btFemFinite::is(saved.m_impulses))
            reject("constraint ", k, " of multibodies is another, or its impulses are not finite");
    }
}

void restoreMultiBodies(const btFemObjectsSnapshot& s, btDiscreteDynamicsWorld& world)
{
    btMultiBodyDynamicsWorld* multi = multiBodyWorld(world);
    for (std::size_t k = 0; k < s.m_multiBodies.size(); ++k)
        restoreOne(s.m_multiBodies[k], *multi->getMultiBody(int(k)));
    for (std::size_t k = 0; k < s.m_linkJoints.size(); ++k)
        for (std::size_t row = 0; row < s.m_linkJoints[k].m_impulses.size(); ++row)
            multi->getMultiBodyConstraint(int(k))->internalSetAppliedImpulse(int(row),
                                                                             s.m_linkJoints[k].m_impulses[row]);
}
