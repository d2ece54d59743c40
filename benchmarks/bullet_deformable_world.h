// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

inline btVector3 toBullet(const Vec3& a)
{
    return btVector3(btScalar(a.x), btScalar(a.y), btScalar(a.z));
}

/// Bullet's deformable world for tetrahedral bodies: implicit, gravity as a force, with projection. Without projection
/// the implicit solve gives NaN, and Bullet then stops the motion.
class BulletDeformableWorld
{
public:
    /// `solver` must outlive the world. gravity [m/s2].
    BulletDeformableWorld(btDeformableBodySolver& solver, const Vec3& gravity);

    /// Adds a body that has tetrahedra and node masses, and fills in data that appendTetra leaves out and the
    /// deformable forces read. Bullet uses the same Rayleigh damping, so alpha and beta apply unchanged. Remove the
    /// body before deleting it or the world. `elasticity` must outlive the body in the world; it has one material and
    /// must be one object for all bodies of a world, because Bullet keeps one force of each kind.
    void add(btSoftBody& body, btDeformableLinearElasticityForce& elasticity, const Material& material);

    /// Makes one step of exactly h [s].
    void step(double h) { m_world.stepSimulation(btScalar(h), 0); }

    btDeformableMultiBodyDynamicsWorld& world() { return m_world; }

private:
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    btDeformableMultiBodyConstraintSolver m_rigidSolver;
    btDeformableGravityForce m_gravityForce;
    btDeformableMultiBodyDynamicsWorld m_world;
};

}  // namespace bullet_fem
