// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "BulletCollision/CollisionDispatch/btCollisionWorld.h"
#include "bullet_fem/fem/common/export.h"

class btSoftBody;

/// Where a ray meets the surface of a soft body.
struct btFemRayHit
{
    int m_face = -1;                    ///< index into m_faces; -1: none, or the body has no faces
    int m_nodes[3] = {-1, -1, -1};      ///< of the triangle
    btScalar m_weights[3] = {0, 0, 0};  ///< barycentric [-], sum 1
    btScalar m_fraction = 1;            ///< of the way from its start to its end [-], in [0, 1]
    btVector3 m_point{0, 0, 0};         ///< world [m]
    btVector3 m_normal{0, 0, 0};        ///< unit [-], of the triangle, against the ray
};

/// Rays against the faces of any btSoftBody where its nodes are now; of one without faces against the sides of its
/// tetrahedra. Double precision inside, without gaps between triangles. Bullet's own btSoftBody::rayTest and
/// world.rayTest work on FEM bodies, but their tolerance is an absolute one: in single precision they are good for
/// triangles with edges of some 0.1 m and more, while those of 0.02 m are hit from several edges beside.
struct BULLETFEM_API btFemRay
{
    /// The first hit between two points [m]; false if there is none, or the points are the same or not finite. Looks at
    /// every face; allocates nothing.
    static bool test(const btSoftBody* body, const btVector3& from, const btVector3& to, btFemRayHit* hit = nullptr);
};

/// For world.rayTest: like Bullet's ClosestRayResultCallback, but what is said of soft bodies is what btFemRay finds.
/// m_hitNormalWorld, m_hitPointWorld, m_collisionObject and m_closestHitFraction as usual.
struct BULLETFEM_API btFemClosestRay : public btCollisionWorld::ClosestRayResultCallback
{
    /// Between two points of the world [m].
    btFemClosestRay(const btVector3& from, const btVector3& to) : ClosestRayResultCallback(from, to) {}

    /// Called by the world: what btFemRay finds of a soft body, and of others what Bullet says. Returns
    /// m_closestHitFraction [-], in [0, 1].
    btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool normalInWorldSpace) override;

    btFemRayHit m_hit;  ///< where the soft body was hit; m_nodes are -1 if m_collisionObject is none
};
