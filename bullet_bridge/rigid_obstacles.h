// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact_solver.h"

class btCollisionObject;
class btRigidBody;

namespace bullet_fem
{

/// The rigid side of a step's contacts: turns Bullet's collision objects into obstacles, and hands the reactions back.
/// What single precision cuts off a rigid body's velocity is carried to the next step.
class RigidObstacles
{
public:
    /// Forgets the objects of the last step; remainders are kept.
    void clear();

    /// Index of an object's obstacle, made when first asked for. `step` [s] is the world's. The rigid solver has
    /// already moved dynamic bodies, so their rows use the velocity that they will have next: v + h g.
    int indexOf(const btCollisionObject& object, double step);

    std::vector<Obstacle>& obstacles() { return m_obstacles; }
    const std::vector<Obstacle>& obstacles() const { return m_obstacles; }

    /// Adds the impulses of the contacts to the rigid bodies' velocities, in double and once, wakes those that felt
    /// any, and moves them by the position corrections.
    void applyReactions(const std::vector<ContactPoint>& contacts, double step);

private:
    struct Source
    {
        const btCollisionObject* m_object;
        int m_objectId;
        Vec3 m_linearImpulse, m_angularImpulse;  // of all contacts, on the rigid body
    };
    struct Remainder
    {
        int m_objectId;
        Vec3 m_linear, m_angular;  // [m/s], [rad/s]
        bool m_used;
    };

    void applyTo(btRigidBody& body, const Source& source, const Obstacle& obstacle, double step);
    Remainder& remainderOf(int objectId);

    std::vector<Obstacle> m_obstacles;
    std::vector<Source> m_sources;
    std::vector<Remainder> m_remainders;
};

/// Bullet's id of an object in its broadphase: unique in a world and never reused; -1 outside a world.
int broadphaseId(const btCollisionObject& object);

}  // namespace bullet_fem
