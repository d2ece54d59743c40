// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/rigid_contacts.h"

#include <algorithm>

#include "BulletCollision/BroadphaseCollision/btDispatcher.h"
#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kRecovery = 0.2;  // share of a penetration that Bullet corrects in a step [-]
constexpr int kFar = 6;            // levels of neighbouring rigid bodies that count as movable

// Links of multibodies are left out: their multibody responds for them.
bool isRigid(const btCollisionObject& object)
{
    return hasRigidContacts(object) && !btMultiBodyLinkCollider::upcast(&object);
}

// Velocity at a point of a kinematic object; 0 for other objects without a rigid proxy [m/s].
Vec3 velocityOf(const btCollisionObject& object, const Vec3& point)
{
    if (!object.isKinematicObject() || !object.isActive()) return {};
    return vec3(object.getInterpolationLinearVelocity()) +
           cross(vec3(object.getInterpolationAngularVelocity()), point - vec3(object.getWorldTransform().getOrigin()));
}

}  // namespace

void RigidContactFinder::find(btDispatcher& dispatcher, double step, RigidProxies& rigidProxies,
                              std::vector<RigidContact>& touches)
{
    m_pairs.clear();
    listPairs(dispatcher);
    lookUp(rigidProxies);
    for (int far = 0; far < kFar && rigidProxies.phase() == RigidPhase::moved && spread(step, rigidProxies); ++far)
        lookUp(rigidProxies);
    keepTouching();
    for (const Pair& pair : m_pairs)
        for (int k = 0; k < pair.m_manifold->getNumContacts(); ++k)
            add(pair, pair.m_manifold->getContactPoint(k), step, rigidProxies, touches);
}

void RigidContactFinder::listPairs(btDispatcher& dispatcher)
{
    for (int k = 0; k < dispatcher.getNumManifolds(); ++k)
    {
        const btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(k);
        if (manifold->getNumContacts() > 0 && isRigid(*manifold->getBody0()) && isRigid(*manifold->getBody1()))
            m_pairs.push_back({manifold, -1, -1});
    }
}

void RigidContactFinder::lookUp(const RigidProxies& rigidProxies)
{
    const auto obstacleOf = [&](const btCollisionObject* object)
    { return movableBody(*object) ? rigidProxies.find(*object) : -1; };
    for (Pair& pair : m_pairs)
    {
        pair.m_first = obstacleOf(pair.m_manifold->getBody0());
        pair.m_second = obstacleOf(pair.m_manifold->getBody1());
    }
}

// Removes pairs without a rigid proxy. Sorts by ids, as Bullet's order depends on the history of its pairs.
void RigidContactFinder::keepTouching()
{
    const auto isApart = [](const Pair& pair) { return pair.m_first < 0 && pair.m_second < 0; };
    m_pairs.erase(std::remove_if(m_pairs.begin(), m_pairs.end(), isApart), m_pairs.end());
    std::sort(m_pairs.begin(), m_pairs.end(),
              [](const Pair& a, const Pair& b) { return orderOf(*a.m_manifold) < orderOf(*b.m_manifold); });
}

// Makes rigid proxies of the neighbours of rigid proxies. False if there are no new ones.
bool RigidContactFinder::spread(double step, RigidProxies& rigidProxies)
{
    const std::size_t before = rigidProxies.rigidProxies().size();
    for (const Pair& pair : m_pairs)
    {
        const btCollisionObject &a = *pair.m_manifold->getBody0(), &b = *pair.m_manifold->getBody1();
        if (pair.m_first >= 0 && pair.m_second < 0 && movableBody(b)) rigidProxies.indexBeside(b, step, pair.m_first);
        if (pair.m_second >= 0 && pair.m_first < 0 && movableBody(a)) rigidProxies.indexBeside(a, step, pair.m_second);
    }
    return rigidProxies.rigidProxies().size() > before;
}

// Adds a contact point as a unilateral row. Bullet measured the gap as the step began. Soft bodies must neither close
// more than the remaining gap nor cancel the separation that Bullet gave the two; Bullet itself resolves approach and
// penetration that exist without soft bodies.
void RigidContactFinder::add(const Pair& pair, const btManifoldPoint& point, double step,
                             const RigidProxies& rigidProxies, std::vector<RigidContact>& touches) const
{
    const bool moved = rigidProxies.phase() == RigidPhase::moved, turned = pair.m_first < 0;
    const btCollisionObject* objects[2] = {pair.m_manifold->getBody0(), pair.m_manifold->getBody1()};
    const int indices[2] = {pair.m_first, pair.m_second};
    Vec3 at = vec3(point.getPositionWorldOnB()), velocities[2];
    bool rewound = false, givesWay = false;
    for (int side = 0; side < 2; ++side)
    {
        if (indices[side] < 0)
        {
            velocities[side] = velocityOf(*objects[side], at);
            givesWay = givesWay || movableBody(*objects[side]);
            continue;
        }
        const LinkMotion now = rigidProxies.motionNow(indices[side]);
        const Vec3 center = vec3(movableBody(*objects[side])->getCenterOfMassPosition());
        const Vec3 arm = at - (moved ? center - step * now.m_linear : center);
        velocities[side] = now.m_linear + cross(now.m_angular, arm);
        rewound = rewound || rigidProxies.isRewound(indices[side]);
    }
    const Vec3 normal = vec3(point.m_normalWorldOnB);
    RigidContact touch;
    touch.m_moves = rewound || !moved;
    touch.m_gap = double(point.getDistance());
    if (!touch.m_moves)
    {
        touch.m_gap += step * dot(normal, velocities[0] - velocities[1]);
        at += 0.5 * step * (velocities[0] + velocities[1]);
    }
    Vec3 arms[2];
    for (int side = 0; side < 2; ++side)
    {
        if (indices[side] < 0) continue;
        const RigidProxy& rigidProxy = rigidProxies.rigidProxies()[indices[side]];
        arms[side] = at - rigidProxy.m_center;
        velocities[side] = rigidProxy.m_linearVelocity + cross(rigidProxy.m_angularVelocity, arms[side]);
    }
    const double recovers = touch.m_moves ? kRecovery : 0;
    const double allowed = -(touch.m_gap > 0 ? 1 : recovers) * touch.m_gap / step;
    touch.m_leastSpeed = std::min(dot(normal, velocities[0] - velocities[1]), allowed);
    touch.m_normal = turned ? -normal : normal;
    touch.m_rigidProxy = indices[turned ? 1 : 0];
    touch.m_other = indices[turned ? 0 : 1];
    touch.m_arm = arms[turned ? 1 : 0];
    touch.m_otherArm = arms[turned ? 0 : 1];
    if (touch.m_other < 0) touch.m_otherVelocity = velocities[turned ? 0 : 1];
    touch.m_friction = std::max(0.0, double(point.m_combinedFriction));
    touch.m_pushOnly = !moved || givesWay;
    touch.m_isSupport = touch.m_other < 0 && !givesWay && dot(touch.m_otherVelocity, touch.m_otherVelocity) == 0;
    touches.push_back(touch);
}

}  // namespace bullet_fem
