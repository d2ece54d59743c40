// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rigid_objects.h"

#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"

namespace bullet_fem
{

btRigidBody* movableBody(const btCollisionObject& object)
{
    auto* body = const_cast<btRigidBody*>(btRigidBody::upcast(&object));
    return body && !body->isStaticOrKinematicObject() && body->getInvMass() > 0 ? body : nullptr;
}

const btMultiBodyLinkCollider* linkOf(const btCollisionObject& object)
{
    const btMultiBodyLinkCollider* link = btMultiBodyLinkCollider::upcast(&object);
    return link && link->m_multiBody && link->m_link < link->m_multiBody->getNumLinks() ? link : nullptr;
}

// Component by component through a volatile: GCC 12 otherwise vectorises and drops the conversion to single precision
// and back, so that no remainder would be left.
btVector3 addedExactly(const btVector3& velocity, const Vec3& change, Vec3& remainder)
{
    btVector3 result(0, 0, 0);
    for (int c = 0; c < 3; ++c)
    {
        const double exact = double(velocity[c]) + remainder[c] + change[c];
        const volatile btScalar rounded = static_cast<btScalar>(exact);
        result[c] = rounded;
        remainder[c] = exact - double(rounded);
    }
    return result;
}

int broadphaseId(const btCollisionObject& object)
{
    return object.getBroadphaseHandle() ? object.getBroadphaseHandle()->m_uniqueId : -1;
}

std::tuple<int, int, int> orderOf(const btPersistentManifold& manifold)
{
    return {broadphaseId(*manifold.getBody0()), broadphaseId(*manifold.getBody1()), manifold.m_index1a};
}

bool hasRigidContacts(const btCollisionObject& object)
{
    return object.hasContactResponse() && object.getInternalType() != btCollisionObject::CO_SOFT_BODY;
}

}  // namespace bullet_fem
