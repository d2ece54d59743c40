// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

class btBroadphaseInterface;

namespace bullet_fem
{

/// The objects of a world and their ids in its broad phase, which identify them in a snapshot: addresses change from
/// run to run and are reused. Pointers to objects that no longer exist are compared, never dereferenced.
class WorldIds
{
public:
    static constexpr int kNone = -1;  ///< id of a null pointer
    static constexpr int kGone = -2;  ///< id of an object that is not in the world

    WorldIds() = default;

    /// Reads all objects of a broad phase with their ids.
    explicit WorldIds(btBroadphaseInterface& broadphase);

    /// The id of an object; kNone for null, kGone if it is not in the world. The pointer may dangle.
    int idOf(const btCollisionObject* object) const;

    /// The object of an id; null if the world does not contain it.
    const btCollisionObject* objectOf(int id) const;

    /// The FEM body at this address; null if there is none. The pointer may dangle.
    FemSoftBody* bodyAt(const btCollisionObject* object) const;
    FemSoftBody* bodyOf(int id) const { return id >= 0 ? bodyAt(objectOf(id)) : nullptr; }

    /// The FEM bodies of the world.
    std::vector<FemSoftBody*> m_bodies;

private:
    using Pair = std::pair<const btCollisionObject*, int>;
    std::vector<Pair> m_byAddress;
    std::vector<Pair> m_byId;
};

}  // namespace bullet_fem
