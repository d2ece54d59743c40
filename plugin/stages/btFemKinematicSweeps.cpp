// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemKinematicSweeps.h"

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btAabbUtil2.h"
#include "bullet_bridge/rigid/broadphase_objects.h"
#include "bullet_bridge/rigid/multibody_dynamics.h"
#include "bullet_bridge/rigid/rigid_objects.h"
#include "bullet_fem/btFemVectors.h"

void btFemKinematicSweeps::list(btBroadphaseInterface& broadphase, double step)
{
    m_sweeps.clear();
    const auto visit = [&](const btCollisionObject* object)
    {
        const btRigidBody* body = object->isKinematicObject() ? btRigidBody::upcast(object) : nullptr;
        const btMultiBodyLinkCollider* link = bullet_fem::linkOf(*object);
        Sweep sweep;
        if (link)
            sweep.m_way = bulletVector(step * bullet_fem::motionOf(*link, m_scratch).m_linear);
        else if (body)
            sweep.m_way = btScalar(-step) * body->getLinearVelocity();
        else
            return;
        object->getCollisionShape()->getAabb(object->getWorldTransform(), sweep.m_low, sweep.m_high);
        const btVector3 size = sweep.m_high - sweep.m_low;
        if (sweep.m_way.length() > size[size.minAxis()]) m_sweeps.push_back(sweep);
    };
    bullet_fem::forEachObject(broadphase, visit);
}

bool btFemKinematicSweeps::Sweep::passes(const btSoftBody& soft) const
{
    btVector3 low = m_low, high = m_high;
    low.setMin(m_low + m_way);
    high.setMax(m_high + m_way);
    return TestAabbAgainstAabb2(low, high, soft.m_bounds[0], soft.m_bounds[1]) &&
           !TestAabbAgainstAabb2(m_low, m_high, soft.m_bounds[0], soft.m_bounds[1]);
}

bool btFemKinematicSweeps::sweepOver(const btSoftBody& soft) const
{
    for (const Sweep& sweep : m_sweeps)
        if (sweep.passes(soft)) return true;
    return false;
}

void btFemKinematicSweeps::widenBounds(btSoftBody& soft) const
{
    for (const Sweep& sweep : m_sweeps)
    {
        if (!sweep.passes(soft)) continue;
        const btVector3 low = soft.m_bounds[0] - sweep.m_way, high = soft.m_bounds[1] - sweep.m_way;
        soft.m_bounds[0].setMin(low);
        soft.m_bounds[1].setMax(high);
    }
}
