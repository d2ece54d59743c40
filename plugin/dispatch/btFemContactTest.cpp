// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/dispatch/btFemContactTest.h"

#include <algorithm>

#include "BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h"
#include "BulletCollision/CollisionDispatch/btCollisionConfiguration.h"
#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletCollision/CollisionDispatch/btManifoldResult.h"
#include "plugin/dispatch/btFemPair.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemTouches.h"

namespace
{

/// Reports the known contact points of a pair, without collision detection.
class LastContacts : public btCollisionAlgorithm
{
public:
    explicit LastContacts(const btCollisionAlgorithmConstructionInfo& info) : btCollisionAlgorithm(info) {}

    void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, const btDispatcherInfo&,
                          btManifoldResult* result) override
    {
        const btFemPair pair = femPair(*a->getCollisionObject(), *b->getCollisionObject());
        if (!pair.m_record) return;
        // Bullet's results ask a manifold for the order of the two objects.
        btPersistentManifold order(a->getCollisionObject(), b->getCollisionObject(), 0, BT_LARGE_FLOAT, 0);
        btPersistentManifold* given = result->getPersistentManifold();
        if (!given) result->setPersistentManifold(&order);
        const btScalar slack = std::max(touchSlack(*pair.m_record), result->m_closestPointDistanceThreshold);
        const auto& contacts = pair.m_record->m_reports.m_contacts;
        for (int k = 0; k < contacts.size(); ++k)
            if (contacts[k].m_other == pair.m_other && isTouch(contacts[k], slack)) tell(pair, contacts[k], *result);
        result->setPersistentManifold(given);
    }

    btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                   btManifoldResult*) override
    {
        return 1;
    }

    void getAllContactManifolds(btManifoldArray&) override {}

private:
    static void tell(const btFemPair& pair, const btFemContact& contact, btManifoldResult& result)
    {
        const btFemPairPoint point = pairPoint(pair, contact);
        const int part = contact.m_part, index = contact.m_index;
        result.setShapeIdentifiersA(pair.m_isFirst ? -1 : part, pair.m_isFirst ? -1 : index);
        result.setShapeIdentifiersB(pair.m_isFirst ? part : -1, pair.m_isFirst ? index : -1);
        result.addContactPoint(point.m_normal, point.m_onSecond, contact.m_gap);
    }
};

/// Bodies moved by Bullet's springs keep Bullet's algorithms. Stateless, so one object serves all dispatchers.
class CreateLastContacts : public btCollisionAlgorithmCreateFunc
{
public:
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override
    {
        if (femPair(*a->getCollisionObject(), *b->getCollisionObject()).m_record)
            return new (info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(LastContacts))) LastContacts(info);
        btCollisionConfiguration* bullet =
            static_cast<btCollisionDispatcher*>(info.m_dispatcher1)->getCollisionConfiguration();
        return bullet
            ->getClosestPointsAlgorithmCreateFunc(a->getCollisionShape()->getShapeType(),
                                                  b->getCollisionShape()->getShapeType())
            ->CreateCollisionAlgorithm(info, a, b);
    }
};

}  // namespace

void answerContactTests(btDispatcher* dispatcher)
{
    auto* collisions = dynamic_cast<btCollisionDispatcher*>(dispatcher);
    if (!collisions) return;
    static CreateLastContacts create;
    for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type)
    {
        collisions->registerClosestPointsCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &create);
        collisions->registerClosestPointsCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &create);
    }
}
