// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <tuple>

#include "LinearMath/btVector3.h"
#include "bullet_fem/fem/common/vec3.h"

class btCollisionObject;
class btMultiBodyLinkCollider;
class btPersistentManifold;
class btRigidBody;

namespace bullet_fem
{

/// Velocity of a rigid body.
struct LinkMotion
{
    Vec3 m_linear;   ///< of the centre of mass [m/s]
    Vec3 m_angular;  ///< [rad/s]
};

/// The movable rigid body of an object; null for static, kinematic and other objects.
btRigidBody* movableBody(const btCollisionObject& object);

/// The link of a multibody, if it still exists; null for other objects.
const btMultiBodyLinkCollider* linkOf(const btCollisionObject& object);

/// True if one of the vectors is not 0.
inline bool isAny(const Vec3& linear, const Vec3& angular)
{
    return dot(linear, linear) + dot(angular, angular) > 0;
}

/// Returns velocity + remainder + change rounded to Bullet's precision, and sets `remainder` to the rounding error.
/// Units are those of the velocity.
btVector3 addedExactly(const btVector3& velocity, const Vec3& change, Vec3& remainder);

/// Bullet's broadphase id of an object, unique in a world and never reused; -1 outside a world.
int broadphaseId(const btCollisionObject& object);

/// Orders manifolds by their objects' ids: Bullet's own order depends on the history of its pairs.
std::tuple<int, int, int> orderOf(const btPersistentManifold& manifold);

/// True if Bullet's rigid solvers resolve contacts of the object, a link of a multibody included.
bool hasRigidContacts(const btCollisionObject& object);

}  // namespace bullet_fem
