// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/shapes/concave_dispatch.h"

#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h"
#include "BulletSoftBody/btSoftRigidCollisionAlgorithm.h"
#include "bullet_bridge/body_mark.h"

namespace bullet_fem
{

namespace
{

/// Bullet's algorithm for convex shapes, which hands the whole shape to the soft body solver, for FEM bodies; its
/// algorithm for concave ones for others. It has no state, so one serves all dispatchers and threads.
class CreateOnce : public btCollisionAlgorithmCreateFunc
{
public:
    explicit CreateOnce(bool swapped) { m_once.m_swapped = m_swapped = swapped; }

    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override
    {
        const btSoftBody* soft = btSoftBody::upcast((m_swapped ? b : a)->getCollisionObject());
        if (soft && isMarked(*soft)) return m_once.CreateCollisionAlgorithm(info, a, b);
        if (m_swapped) return m_swappedBullets.CreateCollisionAlgorithm(info, a, b);
        return m_bullets.CreateCollisionAlgorithm(info, a, b);
    }

private:
    btSoftRigidCollisionAlgorithm::CreateFunc m_once;
    btSoftBodyConcaveCollisionAlgorithm::CreateFunc m_bullets;
    btSoftBodyConcaveCollisionAlgorithm::SwappedCreateFunc m_swappedBullets;
};

}  // namespace

void dispatchConcaveShapesOnce(btDispatcher* dispatcher)
{
    auto* collisions = dynamic_cast<btCollisionDispatcher*>(dispatcher);
    if (!collisions) return;
    static CreateOnce softFirst(false), softSecond(true);
    for (int type = CONCAVE_SHAPES_START_HERE + 1; type < CONCAVE_SHAPES_END_HERE; ++type)
    {
        collisions->registerCollisionCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &softFirst);
        collisions->registerCollisionCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &softSecond);
    }
}

}  // namespace bullet_fem
