// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

class btBroadphaseInterface;
class btCollisionObject;
class btSoftBody;

namespace bullet_fem
{

/// What a world holds, as its broadphase knows it: pointers to objects that were removed or deleted, which nothing in
/// Bullet tells soft bodies of, are recognised without being followed. Allocates when the world has grown.
class WorldObjects
{
public:
    /// Reads the broadphase of the body's world info, unless it did since the last forget().
    void read(const btSoftBody& body);
    void forget() { m_broadphase = nullptr; }

    /// True if it is that broadphase that was read last.
    bool hasRead(const btSoftBody& body) const;

    /// True if the world that was read last holds the body itself.
    bool knows(const btSoftBody& body) const;

    /// True if the world that was read last holds the object; also where that cannot be known, because it does not hold
    /// the body: its world info has no broadphase or not that of its world.
    bool holds(const btSoftBody& body, const btCollisionObject* object) const;

    /// read() and holds().
    bool readAndHolds(const btSoftBody& body, const btCollisionObject* object)
    {
        read(body);
        return holds(body, object);
    }

    /// True if `cluster` is one of a soft body that the world holds, or that cannot be known.
    bool holdsCluster(const btSoftBody& body, const void* cluster) const;

private:
    bool contains(const void* object) const;

    const btBroadphaseInterface* m_broadphase = nullptr;
    std::vector<const void*> m_objects;  // sorted by address, which decides nothing but membership
};

}  // namespace bullet_fem
