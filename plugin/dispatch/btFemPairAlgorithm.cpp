// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/dispatch/btFemPairAlgorithm.h"

#include <array>
#include <utility>

#include "BulletCollision/BroadphaseCollision/btDispatcher.h"
#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletCollision/CollisionDispatch/btManifoldResult.h"
#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h"
#include "BulletSoftBody/btSoftBodySolvers.h"
#include "bullet_bridge/body/rigid_dispatch.h"
#include "bullet_bridge/contact/friction.h"
#include "plugin/dispatch/btFemPair.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemTouches.h"

// Bullet's pool does not check the size of its elements, which is that of Bullet's own algorithms.
static_assert(sizeof(btFemPairAlgorithm) <= sizeof(btSoftBodyConcaveCollisionAlgorithm));

namespace
{

/// The contact points of smallest gap, in ascending order.
struct Deepest
{
    std::array<const btFemContact*, MANIFOLD_CACHE_SIZE> m_points;
    int m_count = 0;
};

Deepest deepestOf(const btFemPair& pair)
{
    Deepest deepest;
    const btScalar slack = touchSlack(*pair.m_record);
    const auto& contacts = pair.m_record->m_reports.m_contacts;
    for (int k = 0; k < contacts.size(); ++k)
    {
        const btFemContact* point = &contacts[k];
        if (point->m_other != pair.m_other || !isTouch(*point, slack)) continue;
        for (int place = 0; place < deepest.m_count; ++place)
            if (point->m_gap < deepest.m_points[place]->m_gap) std::swap(point, deepest.m_points[place]);
        if (deepest.m_count < MANIFOLD_CACHE_SIZE) deepest.m_points[deepest.m_count++] = point;
    }
    return deepest;
}

// Friction and restitution used in the step.
void setCoefficients(const btFemPair& pair, btManifoldPoint& point)
{
    const btSoftBody& body = *pair.m_record->m_softBody;
    point.m_combinedFriction = static_cast<btScalar>(bullet_fem::frictionBetween(body, *pair.m_other));
    point.m_combinedRestitution = body.getRestitution() * pair.m_other->getRestitution();
}

btManifoldPoint manifoldPoint(const btFemPair& pair, const btFemContact& contact, const btPersistentManifold& manifold)
{
    const btFemPairPoint place = pairPoint(pair, contact);
    btManifoldPoint point(manifold.getBody0()->getWorldTransform().invXform(place.m_onFirst),
                          manifold.getBody1()->getWorldTransform().invXform(place.m_onSecond), place.m_normal,
                          contact.m_gap);
    point.m_positionWorldOnA = place.m_onFirst;
    point.m_positionWorldOnB = place.m_onSecond;
    (pair.m_isFirst ? point.m_partId1 : point.m_partId0) = contact.m_part;
    (pair.m_isFirst ? point.m_index1 : point.m_index0) = contact.m_index;
    setCoefficients(pair, point);
    point.m_appliedImpulse = contact.m_normalImpulse;
    btPlaneSpace1(place.m_normal, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2);
    point.m_appliedImpulseLateral1 = place.m_friction.dot(point.m_lateralFrictionDir1);
    point.m_appliedImpulseLateral2 = place.m_friction.dot(point.m_lateralFrictionDir2);
    return point;
}

// As in Bullet for its own points; changes by the callback have no effect, because the step is over.
void tellAdded(btManifoldPoint& point, const btPersistentManifold& manifold)
{
    const btCollisionObject *a = manifold.getBody0(), *b = manifold.getBody1();
    const int flags = a->getCollisionFlags() | b->getCollisionFlags();
    if (!gContactAddedCallback || !(flags & btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK)) return;
    const btCollisionObjectWrapper wrapA(nullptr, a->getCollisionShape(), a, a->getWorldTransform(), point.m_partId0,
                                         point.m_index0);
    const btCollisionObjectWrapper wrapB(nullptr, b->getCollisionShape(), b, b->getWorldTransform(), point.m_partId1,
                                         point.m_index1);
    gContactAddedCallback(point, &wrapA, point.m_partId0, point.m_index0, &wrapB, point.m_partId1, point.m_index1);
}

// Points have no identity over steps: their lifetime is that of the contact, and user pointers keep their position.
void setPoint(btPersistentManifold& manifold, int index, const btManifoldPoint& point)
{
    const bool isNew = index >= manifold.getNumContacts();
    if (isNew) manifold.setNumContacts(index + 1);
    btManifoldPoint& old = manifold.getContactPoint(index);
    void* users = isNew ? nullptr : old.m_userPersistentData;
    old = point;
    old.m_userPersistentData = users;
}

}  // namespace

btFemPairAlgorithm::btFemPairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const Objects& objects,
                                       std::shared_ptr<btFemManifolds> manifolds)
    : btCollisionAlgorithm(info), m_objects(objects), m_manifolds(std::move(manifolds))
{
    // Programs without soft bodies read the first object only.
    if (btSoftBody::upcast(m_objects.m_first)) std::swap(m_objects.m_first, m_objects.m_second);
    m_manifolds->add(this);
}

btFemPairAlgorithm::~btFemPairAlgorithm()
{
    m_manifolds->remove(this);
    release();
    auto* soft = const_cast<btSoftBody*>(btSoftBody::upcast(m_objects.m_second));
    if (!btSoftBody::upcast(m_objects.m_first)) bullet_fem::removeContactsWith(m_objects.m_first, *soft);
}

void btFemPairAlgorithm::processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                                          const btDispatcherInfo& info, btManifoldResult*)
{
    if (!btSoftBody::upcast(a->getCollisionObject())) std::swap(a, b);
    auto* soft = const_cast<btSoftBody*>(btSoftBody::upcast(a->getCollisionObject()));
    auto* other = const_cast<btSoftBody*>(btSoftBody::upcast(b->getCollisionObject()));
    bullet_fem::passDispatchInfo(*soft, info);
    const auto& ignored = soft->m_collisionDisabledObjects;
    if (other)
        soft->getSoftBodySolver()->processCollision(soft, other);
    else if (ignored.findLinearSearch(b->getCollisionObject()) == ignored.size())
        soft->getSoftBodySolver()->processCollision(soft, b);
}

void btFemPairAlgorithm::getAllContactManifolds(btManifoldArray& manifolds)
{
    if (m_manifold) manifolds.push_back(m_manifold);
}

void btFemPairAlgorithm::update()
{
    const btFemPair pair = femPair(*m_objects.m_first, *m_objects.m_second);
    if (pair.m_record && (!pair.m_record->m_membership.m_present || !pair.m_record->m_softBody->isActive())) return;
    if (pair.m_record && touchWith(*pair.m_record, pair.m_other))
        show(pair);
    else
        release();
}

btPersistentManifold* btFemPairAlgorithm::begin()
{
    if (!m_manifold) m_manifold = m_dispatcher->getNewManifold(m_objects.m_first, m_objects.m_second);
    // Makes the rigid solver ignore all points.
    if (m_manifold) m_manifold->setContactProcessingThreshold(-BT_LARGE_FLOAT);
    return m_manifold;
}

void btFemPairAlgorithm::show(const btFemPair& pair)
{
    const bool begins = !m_manifold;
    if (!begin()) return;  // Bullet's pool is full and may not grow
    const Deepest deepest = deepestOf(pair);
    const int lifeTime = begins ? 0 : m_manifold->getContactPoint(0).m_lifeTime + 1;
    for (int k = 0; k < deepest.m_count; ++k)
    {
        btManifoldPoint point = manifoldPoint(pair, *deepest.m_points[k], *m_manifold);
        point.m_lifeTime = lifeTime;
        setPoint(*m_manifold, k, point);
        tellAdded(m_manifold->getContactPoint(k), *m_manifold);
    }
    while (m_manifold->getNumContacts() > deepest.m_count)
        m_manifold->removeContactPoint(m_manifold->getNumContacts() - 1);
    if (begins && gContactStartedCallback) gContactStartedCallback(m_manifold);
}

void btFemPairAlgorithm::release()
{
    if (m_manifold) m_dispatcher->releaseManifold(m_manifold);
    m_manifold = nullptr;
}
