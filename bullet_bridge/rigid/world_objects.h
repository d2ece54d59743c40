// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

class btBroadphaseInterface;
class btCollisionObject;
class btSoftBody;

namespace bullet_fem
{

/// The set of objects of a world, from its broadphase. It recognises pointers to removed or deleted objects without
/// following them; Bullet does not notify soft bodies of removal. Allocates when the world has grown.
class WorldObjects
{
public:
    /// Reads the broadphase of the body's world info, unless it is the one read since the last forget().
    void read(const btSoftBody& body);

    /// Call when the world may have changed: the next read() reads its broadphase again.
    void forget() { m_broadphase = nullptr; }

    /// True if the broadphase of the body's world info is the one that was read last.
    bool hasRead(const btSoftBody& body) const;

    /// True if the world that was read last contains the body itself.
    bool knows(const btSoftBody& body) const;

    /// True if the world that was read last contains the object. Also true if that is unknown, because the world does
    /// not contain the body: its world info has no broadphase, or another one.
    bool holds(const btSoftBody& body, const btCollisionObject* object) const;

    /// Calls read(), then returns holds().
    bool readAndHolds(const btSoftBody& body, const btCollisionObject* object)
    {
        read(body);
        return holds(body, object);
    }

    /// True if `cluster` belongs to a soft body of the world that was read last, or if that is unknown.
    bool holdsCluster(const btSoftBody& body, const void* cluster) const;

private:
    bool contains(const void* object) const;

    const btBroadphaseInterface* m_broadphase = nullptr;
    std::vector<const void*> m_objects;  // sorted by address, for membership tests only
};

}  // namespace bullet_fem
