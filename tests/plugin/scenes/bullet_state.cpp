// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/scenes/bullet_state.h"

namespace bullet_fem
{
namespace
{

btDbvtBroadphase& broadphaseOf(SoftWorld& world)
{
    return *static_cast<btDbvtBroadphase*>(world.bullet().getBroadphase());
}

}  // namespace

BulletState::BulletState(SoftWorld& world)
{
    const btCollisionObjectArray& objects = world.bullet().getCollisionObjectArray();
    for (int k = 0; k < objects.size(); ++k)
    {
        auto* proxy = static_cast<btDbvtProxy*>(objects[k]->getBroadphaseHandle());
        m_bounds.push_back({proxy, proxy->leaf->volume.Mins(), proxy->leaf->volume.Maxs()});  // wider than the object's
        btRigidBody* body = btRigidBody::upcast(objects[k]);
        if (!body) continue;
        m_rigid.push_back({body, body->getWorldTransform(), body->getInterpolationWorldTransform(),
                           body->getLinearVelocity(), body->getAngularVelocity(),
                           body->getInterpolationLinearVelocity(), body->getInterpolationAngularVelocity(),
                           body->getHitFraction(), body->getDeactivationTime(), body->getActivationState()});
    }
    const btBroadphasePairArray& pairs = broadphaseOf(world).getOverlappingPairCache()->getOverlappingPairArray();
    for (int k = 0; k < pairs.size(); ++k) m_pairs.push_back({pairs[k].m_pProxy0, pairs[k].m_pProxy1});
    m_cleanUpAt = broadphaseOf(world).m_cid;
    m_newPairs = broadphaseOf(world).m_newpairs;
}

void BulletState::restore(SoftWorld& world) const
{
    for (const Rigid& rigid : m_rigid)
    {
        btRigidBody& body = *rigid.m_body;
        body.setCenterOfMassTransform(rigid.m_place);
        body.setInterpolationWorldTransform(rigid.m_interpolatedPlace);
        body.setLinearVelocity(rigid.m_velocity);
        body.setAngularVelocity(rigid.m_spin);
        body.setInterpolationLinearVelocity(rigid.m_interpolatedVelocity);
        body.setInterpolationAngularVelocity(rigid.m_interpolatedSpin);
        body.setHitFraction(rigid.m_hitFraction);
        body.forceActivationState(rigid.m_activation);
        body.setDeactivationTime(rigid.m_deactivationTime);
    }
    btDbvtBroadphase& broadphase = broadphaseOf(world);
    btDispatcher* dispatcher = world.bullet().getDispatcher();
    for (const Bounds& bounds : m_bounds)
        broadphase.setAabbForceUpdate(bounds.m_proxy, bounds.m_low, bounds.m_high, dispatcher);
    btOverlappingPairCache& cache = *broadphase.getOverlappingPairCache();
    while (cache.getNumOverlappingPairs() > 0)
    {
        const btBroadphasePair pair = cache.getOverlappingPairArray()[0];
        cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, dispatcher);
    }
    for (const Pair& pair : m_pairs) cache.addOverlappingPair(pair.m_first, pair.m_second);
    broadphase.m_cid = m_cleanUpAt;
    broadphase.m_newpairs = m_newPairs;
}

}  // namespace bullet_fem
