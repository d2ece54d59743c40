// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "BulletCollision/CollisionDispatch/btCollisionWorld.h"
#include "bullet_fem/fem/common/export.h"

class btSoftBody;

/// Intersection of a ray with the surface of a soft body.
struct btFemRayHit
{
    int m_face = -1;                    ///< index into m_faces; -1: no hit, or the body has no faces
    int m_nodes[3] = {-1, -1, -1};      ///< nodes of the triangle
    btScalar m_weights[3] = {0, 0, 0};  ///< barycentric weights [-], sum 1
    btScalar m_fraction = 1;            ///< share of the way from start to end of the ray [-], in [0, 1]
    btVector3 m_point{0, 0, 0};         ///< point in world space [m]
    btVector3 m_normal{0, 0, 0};        ///< unit normal of the triangle [-], directed against the ray
};

/// Ray tests against the faces of any btSoftBody at its present node positions; for a body without faces, against the
/// sides of its tetrahedra. Computes in double precision; no ray passes between adjacent triangles. Bullet's own
/// btSoftBody::rayTest and world.rayTest work on FEM bodies, but have an absolute tolerance: in single precision they
/// suit triangles with edges of some 0.1 m and more, while triangles with edges of 0.02 m are hit by rays that pass
/// several edge lengths away.
struct BULLETFEM_API btFemRay
{
    /// First hit between two points [m]. Returns false if there is none, or if the points are equal or not finite.
    /// Tests every face; allocates nothing.
    static bool test(const btSoftBody* body, const btVector3& from, const btVector3& to, btFemRayHit* hit = nullptr);
};

/// For world.rayTest: as Bullet's ClosestRayResultCallback, with soft bodies tested by btFemRay. m_hitNormalWorld,
/// m_hitPointWorld, m_collisionObject and m_closestHitFraction as usual.
struct BULLETFEM_API btFemClosestRay : public btCollisionWorld::ClosestRayResultCallback
{
    /// A ray between two points of the world [m].
    btFemClosestRay(const btVector3& from, const btVector3& to) : ClosestRayResultCallback(from, to) {}

    /// Called by the world: tests a soft body by btFemRay, and takes Bullet's result for other objects. Returns
    /// m_closestHitFraction [-], in [0, 1].
    btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool normalInWorldSpace) override;

    btFemRayHit m_hit;  ///< hit on a soft body; m_nodes are -1 if m_collisionObject is no soft body
};
