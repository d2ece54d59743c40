// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/enclosing_world.h"

#include <cstddef>

#include "BulletSoftBody/btSoftMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"

namespace bullet_fem
{
namespace
{

const char* bytesOf(const void* object)
{
    return static_cast<const char*>(object);
}

// Positions of members in worlds of one class, measured in an empty one [B].
template <class World>
struct WorldLayout
{
    WorldLayout()
    {
        World world(nullptr, nullptr, nullptr, nullptr);
        m_softBodies = bytesOf(&world.getSoftBodyArray()) - bytesOf(&world);
        m_dispatchInfo = bytesOf(&world.getDispatchInfo()) - bytesOf(&world);
    }

    btDynamicsWorld* around(const btAlignedObjectArray<btSoftBody*>& softBodies, const btDispatcherInfo& info) const
    {
        const char* world = bytesOf(&softBodies) - m_softBodies;
        if (world + m_dispatchInfo != bytesOf(&info)) return nullptr;
        return reinterpret_cast<World*>(const_cast<char*>(world));
    }

    std::ptrdiff_t m_softBodies, m_dispatchInfo;
};

}  // namespace

btDynamicsWorld* enclosingWorld(const btAlignedObjectArray<btSoftBody*>& softBodies, const btDispatcherInfo& info)
{
    static const WorldLayout<btSoftRigidDynamicsWorld> rigid;
    static const WorldLayout<btSoftMultiBodyDynamicsWorld> multiBody;
    btDynamicsWorld* world = rigid.around(softBodies, info);
    return world ? world : multiBody.around(softBodies, info);
}

}  // namespace bullet_fem
