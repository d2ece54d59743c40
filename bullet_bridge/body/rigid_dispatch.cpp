// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/rigid_dispatch.h"

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/CollisionDispatch/btCollisionConfiguration.h"
#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h"
#include "BulletSoftBody/btSoftBodySolvers.h"
#include "BulletSoftBody/btSoftRigidCollisionAlgorithm.h"
#include "bullet_bridge/body/body_mark.h"

namespace bullet_fem
{

namespace
{

thread_local const btDispatcherInfo* threadsDispatchInfo = nullptr;

/// Bullet's algorithm for convex shapes, which passes the whole shape to the soft body solver.
class FemRigidAlgorithm : public btSoftRigidCollisionAlgorithm
{
public:
    FemRigidAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                      const btCollisionObjectWrapper* b, bool swapped)
        : btSoftRigidCollisionAlgorithm(nullptr, info, a, b, swapped),
          m_body(const_cast<btSoftBody*>(btSoftBody::upcast((swapped ? b : a)->getCollisionObject()))),
          m_object((swapped ? a : b)->getCollisionObject())
    {
    }
    // Bullet does not notify anyone when a soft body leaves its world, but it destroys the body's pairs.
    ~FemRigidAlgorithm() override { removeContactsWith(m_object, *m_body); }

    void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                          const btDispatcherInfo& info, btManifoldResult* result) override
    {
        passDispatchInfo(*m_body, info);
        btSoftRigidCollisionAlgorithm::processCollision(a, b, info, result);
    }

private:
    btSoftBody* m_body;
    const btCollisionObject* m_object;
};

// Bullet's pool does not check the size of its elements, which is that of Bullet's own algorithms.
static_assert(sizeof(FemRigidAlgorithm) <= sizeof(btSoftBodyConcaveCollisionAlgorithm));

/// Creates FemRigidAlgorithm for FEM bodies, and Bullet's algorithms for others. It is stateless, so one instance
/// serves all dispatchers and threads.
class CreateForFem : public btCollisionAlgorithmCreateFunc
{
public:
    explicit CreateForFem(bool swapped) { m_swapped = swapped; }

    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override
    {
        const btSoftBody* soft = btSoftBody::upcast((m_swapped ? b : a)->getCollisionObject());
        if (soft && isMarked(*soft))
            return new (info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(FemRigidAlgorithm)))
                FemRigidAlgorithm(info, a, b, m_swapped);
        return createBulletsAlgorithm(info, a, b);
    }
};

// Removes contacts in place: they contain members that are costly to copy, and often all belong to one object.
template <class Contact>
void removeContactsWith(const btCollisionObject* object, btAlignedObjectArray<Contact>& contacts)
{
    int kept = 0;
    for (int k = 0; k < contacts.size(); ++k)
    {
        if (contacts[k].m_cti.m_colObj == object) continue;
        if (kept < k) contacts[kept] = contacts[k];
        ++kept;
    }
    while (contacts.size() > kept) contacts.pop_back();
}

}  // namespace

const btDispatcherInfo* dispatchInfoInUse()
{
    return threadsDispatchInfo;
}

void passDispatchInfo(const btSoftBody& body, const btDispatcherInfo& info)
{
    btSoftBodySolver* solver = const_cast<btSoftBody&>(body).getSoftBodySolver();
    if (!solver) return;
    threadsDispatchInfo = &info;
    solver->checkInitialized();
    threadsDispatchInfo = nullptr;
}

btCollisionAlgorithm* createBulletsAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                             const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b)
{
    btCollisionConfiguration* bullet =
        static_cast<btCollisionDispatcher*>(info.m_dispatcher1)->getCollisionConfiguration();
    const int first = a->getCollisionShape()->getShapeType(), second = b->getCollisionShape()->getShapeType();
    return bullet->getCollisionAlgorithmCreateFunc(first, second)->CreateCollisionAlgorithm(info, a, b);
}

void removeContactsWith(const btCollisionObject* object, btSoftBody& body)
{
    removeContactsWith(object, body.m_rcontacts);
    removeContactsWith(object, body.m_faceRigidContacts);
}

void dispatchRigidShapes(btDispatcher* dispatcher)
{
    auto* collisions = dynamic_cast<btCollisionDispatcher*>(dispatcher);
    if (!collisions) return;
    static CreateForFem softFirst(false), softSecond(true);
    for (int type = 0; type < CONCAVE_SHAPES_END_HERE; ++type)
    {
        if (type == CONCAVE_SHAPES_START_HERE) continue;
        collisions->registerCollisionCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &softFirst);
        collisions->registerCollisionCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &softSecond);
    }
}

void renewAlgorithms(btSoftBody& body)
{
    btDispatcher* dispatcher = body.m_worldInfo->m_dispatcher;
    btBroadphaseInterface* broadphase = body.m_worldInfo->m_broadphase;
    if (dispatcher && broadphase && body.getBroadphaseHandle())
        broadphase->getOverlappingPairCache()->cleanProxyFromPairs(body.getBroadphaseHandle(), dispatcher);
}

void clearBulletContacts(btSoftBody& body)
{
    body.m_rcontacts.resizeNoInitialize(0);
    body.m_scontacts.resizeNoInitialize(0);
    body.m_nodeRigidContacts.resizeNoInitialize(0);
    body.m_faceRigidContacts.resizeNoInitialize(0);
}

}  // namespace bullet_fem
