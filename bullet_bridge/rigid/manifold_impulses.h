// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btVector3.h"

class btDispatcher;
class btManifoldPoint;
class btPersistentManifold;

namespace bullet_fem
{

/// Impulse of friction of a contact point on body 0 in Bullet's last solve [N s].
btVector3 frictionOf(const btManifoldPoint& point);

/// Impulses of Bullet's contact points at the end of the last step, as warm starts for contacts that are solved once
/// more after Bullet's own solver has overwritten them. Grows with the number of points, never shrinks.
class ManifoldImpulses
{
public:
    /// Notes all points of the dispatcher's manifolds. Those solved with set() since the last call start from 0 in
    /// Bullet's own solver: without soft bodies the impulses would throw light rigid bodies.
    void note(btDispatcher& dispatcher);
    void forget() { m_noted.clear(); }

    /// Gives the points of these manifolds the noted impulses, in the directions of friction that Bullet's set-up will
    /// choose, or 0 to new points.
    void set(const std::vector<btPersistentManifold*>& manifolds);

    /// Call with the same manifolds after the solve: restores the points' flags, and directs friction along the first
    /// of its directions. The world's own solver may choose these anew, or use only one and leave the impulse along the
    /// second as it is.
    void finish(const std::vector<btPersistentManifold*>& manifolds) const;

private:
    struct Noted
    {
        const btPersistentManifold* m_manifold;
        btVector3 m_at;        // on body 0, in its axes [m]
        btScalar m_normal;     // [N s]
        btVector3 m_friction;  // [N s]
    };

    const Noted* find(const btPersistentManifold& manifold, const btManifoldPoint& point) const;

    std::vector<Noted> m_noted;                         // sorted by manifold
    std::vector<const btPersistentManifold*> m_solved;  // by set(), sorted by address, which is only compared
    std::vector<int> m_flags;                           // of the points of set(), in their order
};

}  // namespace bullet_fem
