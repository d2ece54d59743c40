// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

class btBroadphaseInterface;

namespace bullet_fem
{

/// The objects of a world and their ids in its broad phase, which tell them from each other in a snapshot: addresses
/// change from run to run, and come to other objects. Pointers to what is gone are recognised without being followed.
class WorldIds
{
public:
    static constexpr int kNone = -1;  ///< of a null pointer
    static constexpr int kGone = -2;  ///< of an object that the world does not hold

    WorldIds() = default;
    explicit WorldIds(btBroadphaseInterface& broadphase);

    int idOf(const btCollisionObject* object) const;

    /// Null if the world does not hold it.
    const btCollisionObject* objectOf(int id) const;

    /// The FEM body that is this object; null if it is none of them. The object may be anything, or gone.
    FemSoftBody* bodyAt(const btCollisionObject* object) const;
    FemSoftBody* bodyOf(int id) const { return id >= 0 ? bodyAt(objectOf(id)) : nullptr; }

    /// FEM bodies of the world.
    std::vector<FemSoftBody*> m_bodies;

private:
    using Pair = std::pair<const btCollisionObject*, int>;
    std::vector<Pair> m_byAddress;
    std::vector<Pair> m_byId;
};

}  // namespace bullet_fem
