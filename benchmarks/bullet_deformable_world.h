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

/// Bullet's own deformable world, set up rightly for a body of tetrahedra: implicit, with projection (without it the
/// implicit solve gives NaN, which Bullet turns into standing still), gravity as a force.
class BulletDeformableWorld
{
public:
    /// `solver` must outlive it. gravity [m/s2].
    BulletDeformableWorld(btDeformableBodySolver& solver, const Vec3& gravity);

    /// Adds a body that has tetrahedra and node masses; completes what appendTetra leaves out and the deformable forces
    /// read. Bullet's damping is the same Rayleigh damping, so alpha and beta go over as they are. Remove the body
    /// before deleting it, or the world. `elasticity` must outlive the body in the world, be of one material, and be
    /// the same for all bodies of a world: Bullet keeps one force of a kind.
    void add(btSoftBody& body, btDeformableLinearElasticityForce& elasticity, const Material& material);

    /// One step of exactly h [s].
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
