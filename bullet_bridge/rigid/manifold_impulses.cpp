// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/manifold_impulses.h"

#include <algorithm>
#include <functional>

#include "BulletCollision/BroadphaseCollision/btDispatcher.h"
#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"

namespace bullet_fem
{
namespace
{

// True if Bullet's set-up keeps the point's directions of friction.
bool hasDirections(const btManifoldPoint& point)
{
    return (point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) != 0;
}

}  // namespace

btVector3 frictionOf(const btManifoldPoint& point)
{
    return point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
           point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
}

void ManifoldImpulses::note(btDispatcher& dispatcher)
{
    m_noted.clear();
    for (int k = 0; k < dispatcher.getNumManifolds(); ++k)
    {
        btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(k);
        const bool isSolved =
            std::binary_search(m_solved.begin(), m_solved.end(), manifold, std::less<const btPersistentManifold*>());
        for (int p = 0; p < manifold->getNumContacts(); ++p)
        {
            btManifoldPoint& point = manifold->getContactPoint(p);
            m_noted.push_back({manifold, point.m_localPointA, point.m_appliedImpulse, frictionOf(point)});
            if (isSolved) point.m_appliedImpulse = point.m_appliedImpulseLateral1 = point.m_appliedImpulseLateral2 = 0;
        }
    }
    m_solved.clear();
    std::sort(m_noted.begin(), m_noted.end(),
              [](const Noted& a, const Noted& b)
              { return std::less<const btPersistentManifold*>()(a.m_manifold, b.m_manifold); });
}

// Collision detection may have replaced or reordered points since then.
const ManifoldImpulses::Noted* ManifoldImpulses::find(const btPersistentManifold& manifold,
                                                      const btManifoldPoint& point) const
{
    const auto isBefore = [](const Noted& noted, const btPersistentManifold* at)
    { return std::less<const btPersistentManifold*>()(noted.m_manifold, at); };
    btScalar nearest = manifold.getContactBreakingThreshold();
    const Noted* found = nullptr;
    for (auto k = std::lower_bound(m_noted.begin(), m_noted.end(), &manifold, isBefore);
         k != m_noted.end() && k->m_manifold == &manifold; ++k)
    {
        const btScalar distance = (k->m_at - point.m_localPointA).length();
        if (!(distance < nearest)) continue;  // no two points of a manifold are equally near
        nearest = distance;
        found = &*k;
    }
    return found;
}

void ManifoldImpulses::set(const std::vector<btPersistentManifold*>& manifolds)
{
    m_flags.clear();
    m_solved.assign(manifolds.begin(), manifolds.end());
    std::sort(m_solved.begin(), m_solved.end(), std::less<const btPersistentManifold*>());
    for (btPersistentManifold* manifold : manifolds)
        for (int p = 0; p < manifold->getNumContacts(); ++p)
        {
            btManifoldPoint& point = manifold->getContactPoint(p);
            m_flags.push_back(point.m_contactPointFlags);
            btVector3 first = point.m_lateralFrictionDir1, second = point.m_lateralFrictionDir2;
            if (!hasDirections(point)) btPlaneSpace1(point.m_normalWorldOnB, first, second);
            const Noted* noted = find(*manifold, point);
            point.m_appliedImpulse = noted ? noted->m_normal : 0;
            point.m_appliedImpulseLateral1 = noted ? noted->m_friction.dot(first) : 0;
            point.m_appliedImpulseLateral2 = noted ? noted->m_friction.dot(second) : 0;
        }
}

void ManifoldImpulses::finish(const std::vector<btPersistentManifold*>& manifolds) const
{
    auto flags = m_flags.begin();
    for (btPersistentManifold* manifold : manifolds)
        for (int p = 0; p < manifold->getNumContacts(); ++p)
        {
            btManifoldPoint& point = manifold->getContactPoint(p);
            point.m_contactPointFlags = *flags++;
            if (hasDirections(point)) continue;
            const btVector3 friction = frictionOf(point);
            const btScalar size = friction.length();
            if (size > 0) point.m_lateralFrictionDir1 = friction / size;
            point.m_appliedImpulseLateral1 = size;
            point.m_appliedImpulseLateral2 = 0;
        }
}

}  // namespace bullet_fem
