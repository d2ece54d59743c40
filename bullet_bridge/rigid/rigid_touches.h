// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>
#include <vector>

#include "bullet_bridge/rigid/rigid_proxies.h"

class btDispatcher;
class btManifoldPoint;
class btPersistentManifold;

namespace bullet_fem
{

/// Finds where the rigid bodies of a step touch each other, and what does not move: Bullet's own contacts. In phase
/// `moved` Bullet has solved them already, without knowing what soft bodies do to its bodies; in phase `solving` it is
/// about to, and only position corrections need them. Scratch only.
class RigidTouchFinder
{
public:
    /// Once all that soft bodies touch are rigid proxies. In phase `moved`, what these touch become rigid proxies, too,
    /// and so on, a few bodies far. `step` [s] is the world's.
    void find(btDispatcher& dispatcher, double step, RigidProxies& rigidProxies, std::vector<RigidTouch>& touches);

private:
    struct Pair
    {
        const btPersistentManifold* m_manifold;
        int m_first, m_second;  // rigid proxies that can move; -1: none
    };

    void listMovable(const RigidProxies& rigidProxies);
    void listPairs(btDispatcher& dispatcher);
    void lookUp();
    bool spread(double step, RigidProxies& rigidProxies);
    void keepTouching();
    void add(const Pair& pair, const btManifoldPoint& point, double step, const RigidProxies& rigidProxies,
             std::vector<RigidTouch>& touches) const;

    std::vector<Pair> m_pairs;
    std::vector<std::pair<const btCollisionObject*, int>> m_byAddress;  // of all rigid proxies that are rigid bodies
};

}  // namespace bullet_fem
