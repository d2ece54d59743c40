// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/rigid/rigid_proxies.h"

class btDispatcher;
class btManifoldPoint;
class btPersistentManifold;

namespace bullet_fem
{

/// Finds the contacts of a step's rigid bodies with each other and with immovable objects, from Bullet's manifolds. In
/// phase `moved` Bullet has solved them already, without the reactions of soft bodies; in phase `solving` Bullet is
/// about to solve them, and only position corrections need them. Keeps no state but scratch.
class RigidContactFinder
{
public:
    /// Appends one RigidContact per contact point. Call after all objects in contact with soft bodies have rigid
    /// proxies. In phase `moved`, it makes rigid proxies of their neighbours, and of the neighbours' neighbours, a few
    /// levels deep. `step` is the world's [s].
    void find(btDispatcher& dispatcher, double step, RigidProxies& rigidProxies, std::vector<RigidContact>& touches);

private:
    struct Pair
    {
        const btPersistentManifold* m_manifold;
        int m_first, m_second;  // movable rigid proxies; -1: none
    };

    void listPairs(btDispatcher& dispatcher);
    void lookUp(const RigidProxies& rigidProxies);
    bool spread(double step, RigidProxies& rigidProxies);
    void keepTouching();
    void add(const Pair& pair, const btManifoldPoint& point, double step, const RigidProxies& rigidProxies,
             std::vector<RigidContact>& touches) const;

    std::vector<Pair> m_pairs;
};

}  // namespace bullet_fem
