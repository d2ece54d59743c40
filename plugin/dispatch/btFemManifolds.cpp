// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/dispatch/btFemManifolds.h"

#include <algorithm>

#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "bullet_bridge/body/rigid_dispatch.h"
#include "plugin/dispatch/btFemPair.h"
#include "plugin/dispatch/btFemPairAlgorithm.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"

namespace
{

/// Null unless the pair has a FEM body whose solver shows manifolds.
std::shared_ptr<btFemManifolds> shownBy(const btFemPair& pair)
{
    return pair.m_record ? btFemCoupling::manifoldsOf(*pair.m_record->m_softBody) : nullptr;
}

/// Other pairs keep Bullet's algorithms. Stateless, so one object serves all dispatchers.
class CreatePairAlgorithm : public btCollisionAlgorithmCreateFunc
{
public:
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override
    {
        const btCollisionObject *first = a->getCollisionObject(), *second = b->getCollisionObject();
        if (const std::shared_ptr<btFemManifolds> manifolds = shownBy(femPair(*first, *second)))
        {
            void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(btFemPairAlgorithm));
            return new (memory) btFemPairAlgorithm(info, {first, second}, manifolds);
        }
        return bullet_fem::createBulletsAlgorithm(info, a, b);
    }
};

}  // namespace

void btFemManifolds::showIn(btDispatcher* dispatcher)
{
    auto* collisions = dynamic_cast<btCollisionDispatcher*>(dispatcher);
    if (!collisions) return;
    static CreatePairAlgorithm create;
    for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type)
    {
        collisions->registerCollisionCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &create);
        collisions->registerCollisionCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &create);
    }
}

void btFemManifolds::update()
{
    for (btFemPairAlgorithm* algorithm : m_algorithms) algorithm->update();
}

void btFemManifolds::add(btFemPairAlgorithm* algorithm)
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_algorithms.push_back(algorithm);
}

void btFemManifolds::remove(btFemPairAlgorithm* algorithm)
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_algorithms.erase(std::find(m_algorithms.begin(), m_algorithms.end(), algorithm));
}
