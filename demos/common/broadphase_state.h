// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "BulletCollision/BroadphaseCollision/btDbvtBroadphase.h"
#include "btBulletDynamicsCommon.h"

namespace bullet_fem
{

/// State of Bullet's own in a world of soft and static bodies: the boxes of its broad phase and its pairs, in order.
class BroadphaseState
{
public:
    /// Stores the present state. The world must have a btDbvtBroadphase and keep its objects.
    explicit BroadphaseState(btDynamicsWorld& world)
        : m_world(world), m_broadphase(*static_cast<btDbvtBroadphase*>(world.getBroadphase()))
    {
        for (int k = 0; k < world.getNumCollisionObjects(); ++k)
        {
            auto* proxy = static_cast<btDbvtProxy*>(world.getCollisionObjectArray()[k]->getBroadphaseHandle());
            m_boxes.push_back({proxy, proxy->leaf->volume.Mins(), proxy->leaf->volume.Maxs()});
        }
        const btBroadphasePairArray& pairs = world.getPairCache()->getOverlappingPairArray();
        for (int k = 0; k < pairs.size(); ++k) m_pairs.push_back({pairs[k].m_pProxy0, pairs[k].m_pProxy1});
        m_cleanUpAt = m_broadphase.m_cid;
        m_newPairs = m_broadphase.m_newpairs;
    }
    /// Restores the state. Bullet's pairs are rebuilt in the process, so call it right after the constructor too: then
    /// both runs begin alike.
    void restore() const
    {
        for (const Box& box : m_boxes)
            m_broadphase.setAabbForceUpdate(box.m_proxy, box.m_low, box.m_high, m_world.getDispatcher());
        btOverlappingPairCache& cache = *m_world.getPairCache();
        while (cache.getNumOverlappingPairs() > 0)
        {
            const btBroadphasePair pair = cache.getOverlappingPairArray()[0];
            cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, m_world.getDispatcher());
        }
        for (const auto& pair : m_pairs) cache.addOverlappingPair(pair.first, pair.second);
        m_broadphase.m_cid = m_cleanUpAt;
        m_broadphase.m_newpairs = m_newPairs;
    }

private:
    struct Box
    {
        btDbvtProxy* m_proxy;
        btVector3 m_low, m_high;
    };
    btDynamicsWorld& m_world;
    btDbvtBroadphase& m_broadphase;
    std::vector<Box> m_boxes;
    std::vector<std::pair<btBroadphaseProxy*, btBroadphaseProxy*>> m_pairs;
    int m_cleanUpAt, m_newPairs;  // Bullet removes a few old pairs per step, from this index on
};

}  // namespace bullet_fem
