// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/snapshot/world_ids.h"

#include <algorithm>
#include <functional>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{
namespace
{

using Pair = std::pair<const btCollisionObject*, int>;

class IdCollector : public btBroadphaseAabbCallback
{
public:
    explicit IdCollector(std::vector<Pair>& pairs) : m_pairs(pairs) {}
    bool process(const btBroadphaseProxy* proxy) override
    {
        m_pairs.emplace_back(static_cast<const btCollisionObject*>(proxy->m_clientObject), proxy->m_uniqueId);
        return true;
    }

private:
    std::vector<Pair>& m_pairs;
};

bool addressBefore(const Pair& a, const btCollisionObject* object)
{
    return std::less<const btCollisionObject*>()(a.first, object);
}

bool idBefore(const Pair& a, int id)
{
    return a.second < id;
}

}  // namespace

WorldIds::WorldIds(btBroadphaseInterface& broadphase)
{
    const btVector3 all(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    IdCollector collector(m_byAddress);
    broadphase.aabbTest(-all, all, collector);
    m_byId = m_byAddress;
    std::sort(m_byAddress.begin(), m_byAddress.end(),
              [](const Pair& a, const Pair& b) { return addressBefore(a, b.first); });
    std::sort(m_byId.begin(), m_byId.end(), [](const Pair& a, const Pair& b) { return a.second < b.second; });
}

int WorldIds::idOf(const btCollisionObject* object) const
{
    if (!object) return kNone;
    const auto found = std::lower_bound(m_byAddress.begin(), m_byAddress.end(), object, addressBefore);
    return found != m_byAddress.end() && found->first == object ? found->second : kGone;
}

const btCollisionObject* WorldIds::objectOf(int id) const
{
    const auto found = std::lower_bound(m_byId.begin(), m_byId.end(), id, idBefore);
    return found != m_byId.end() && found->second == id ? found->first : nullptr;
}

FemSoftBody* WorldIds::bodyAt(const btCollisionObject* object) const
{
    for (FemSoftBody* fem : m_bodies)
        if (object && static_cast<const btCollisionObject*>(fem->m_softBody) == object) return fem;
    return nullptr;
}

}  // namespace bullet_fem
