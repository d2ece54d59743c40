// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/registry/btFemBroadphaseProxy.h"

#include <vector>

#include "BulletCollision/BroadphaseCollision/btDbvtBroadphase.h"
#include "BulletCollision/BroadphaseCollision/btDispatcher.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletSoftBody/btSoftBody.h"

namespace
{

// Collects the proxies of a body in the broad phase that the body does not refer to.
struct LostProxies : btBroadphaseAabbCallback
{
    explicit LostProxies(btSoftBody& body) : m_body(body) {}

    bool process(const btBroadphaseProxy* proxy) override
    {
        if (proxy->m_clientObject == &m_body && proxy != m_body.getBroadphaseHandle())
            m_proxies.push_back(const_cast<btBroadphaseProxy*>(proxy));
        return true;
    }

    btSoftBody& m_body;
    std::vector<btBroadphaseProxy*> m_proxies;
};

// Tells whether a broad phase has a proxy: the world info may refer to another world's.
struct ProxySearch : btBroadphaseAabbCallback
{
    explicit ProxySearch(const btBroadphaseProxy& proxy) : m_proxy(proxy) {}

    bool process(const btBroadphaseProxy* proxy) override
    {
        m_found = m_found || proxy == &m_proxy;
        return true;
    }

    const btBroadphaseProxy& m_proxy;
    bool m_found = false;
};

}  // namespace

void restoreBroadphaseProxy(btSoftBody& body)
{
    const btSoftBodyWorldInfo* info = body.getWorldInfo();
    if (!info || !info->m_broadphase || !info->m_dispatcher) return;
    btBroadphaseInterface& broadphase = *info->m_broadphase;
    LostProxies lost(body);
    const btVector3 everywhere(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    broadphase.aabbTest(-everywhere, everywhere, lost);
    for (btBroadphaseProxy* proxy : lost.m_proxies)
    {
        broadphase.getOverlappingPairCache()->cleanProxyFromPairs(proxy, info->m_dispatcher);
        broadphase.destroyProxy(proxy, info->m_dispatcher);
    }
    if (body.getBroadphaseHandle()) return;
    btVector3 low, high;
    body.getAabb(low, high);
    body.setBroadphaseHandle(broadphase.createProxy(low, high, body.getCollisionShape()->getShapeType(), &body,
                                                    btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter,
                                                    info->m_dispatcher));
}

void fitBroadphaseLeaf(btSoftBody& body)
{
    const btSoftBodyWorldInfo* info = body.getWorldInfo();
    auto* tree = info ? dynamic_cast<btDbvtBroadphase*>(info->m_broadphase) : nullptr;
    btBroadphaseProxy* proxy = body.getBroadphaseHandle();
    if (!tree || !proxy || !info->m_dispatcher) return;
    ProxySearch search(*proxy);
    tree->aabbTest(proxy->m_aabbMin, proxy->m_aabbMax, search);
    if (!search.m_found) return;
    btVector3 low, high;
    body.getAabb(low, high);
    tree->setAabbForceUpdate(proxy, low, high, info->m_dispatcher);
}
