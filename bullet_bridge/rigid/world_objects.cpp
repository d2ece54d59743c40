// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/world_objects.h"

#include <algorithm>
#include <functional>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/rigid/broadphase_objects.h"

namespace bullet_fem
{
void WorldObjects::read(const btSoftBody& body)
{
    if (hasRead(body)) return;
    btBroadphaseInterface* broadphase = body.m_worldInfo ? body.m_worldInfo->m_broadphase : nullptr;
    m_objects.clear();
    if (broadphase)
        forEachObject(*broadphase, [this](const btCollisionObject* object) { m_objects.push_back(object); });
    std::sort(m_objects.begin(), m_objects.end(), std::less<const void*>());
    m_broadphase = broadphase;
}

bool WorldObjects::hasRead(const btSoftBody& body) const
{
    return m_broadphase && body.m_worldInfo && body.m_worldInfo->m_broadphase == m_broadphase;
}

bool WorldObjects::contains(const void* object) const
{
    return std::binary_search(m_objects.begin(), m_objects.end(), object, std::less<const void*>());
}

// A broadphase that contains the body itself is that of the body's world.
bool WorldObjects::knows(const btSoftBody& body) const
{
    return contains(&body);
}

bool WorldObjects::holds(const btSoftBody& body, const btCollisionObject* object) const
{
    return !knows(body) || contains(object);
}

bool WorldObjects::holdsCluster(const btSoftBody& body, const void* cluster) const
{
    const auto isOf = [cluster](const void* object)
    {
        const btSoftBody* soft = btSoftBody::upcast(static_cast<const btCollisionObject*>(object));
        for (int c = 0; soft && c < soft->m_clusters.size(); ++c)
            if (soft->m_clusters[c] == cluster) return true;
        return false;
    };
    return !contains(&body) || std::any_of(m_objects.begin(), m_objects.end(), isOf);
}

}  // namespace bullet_fem
