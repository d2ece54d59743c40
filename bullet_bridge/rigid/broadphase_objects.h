// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/CollisionDispatch/btCollisionObject.h"

namespace bullet_fem
{

/// Calls visit(object) with every btCollisionObject* of a broadphase, in an order that depends on its history.
template <class Visit>
void forEachObject(btBroadphaseInterface& broadphase, const Visit& visit)
{
    struct Visitor : btBroadphaseAabbCallback
    {
        explicit Visitor(const Visit& visit) : m_visit(visit) {}
        bool process(const btBroadphaseProxy* proxy) override
        {
            m_visit(static_cast<btCollisionObject*>(proxy->m_clientObject));
            return true;
        }
        const Visit& m_visit;
    };
    const btVector3 all(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    Visitor visitor(visit);
    broadphase.aabbTest(-all, all, visitor);
}

}  // namespace bullet_fem
