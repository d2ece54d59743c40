// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemConstraintSolver.h"

namespace bullet_fem
{

constexpr btScalar kStep = btScalar(1) / 60;  ///< the usual time step [s]
constexpr double kGravity = 9.81;             ///< [m/s2], along -z

/// How a rigid body starts.
struct RigidSettings
{
    btScalar m_mass = 0;  ///< [kg]; 0 is static
    btTransform m_transform = btTransform::getIdentity();
    btScalar m_friction = 1;        ///< [-]
    btVector3 m_velocity{0, 0, 0};  ///< [m/s]
    btVector3 m_spin{0, 0, 0};      ///< [rad/s]
};

/// How rigid bodies are solved.
enum class Coupling
{
    swap,    ///< by Bullet's own solver: they feel the soft bodies after they have moved
    coupled  ///< by a btFemConstraintSolver, together with the soft bodies
};

/// For names of tests.
inline const char* couplingName(Coupling coupling)
{
    return coupling == Coupling::swap ? "swap" : "coupled";
}

/// A btSoftRigidDynamicsWorld that deletes its bodies, their shapes and motion states. Gravity is along -z, for rigid
/// and soft bodies alike; nothing falls asleep.
class SoftWorld
{
public:
    /// The solver must outlive the world.
    explicit SoftWorld(btSoftBodySolver& solver, const btVector3& gravity = {0, 0, btScalar(-kGravity)});
    SoftWorld(btFemSoftBodySolver& solver, Coupling coupling, const btVector3& gravity = {0, 0, btScalar(-kGravity)});
    ~SoftWorld();
    SoftWorld(const SoftWorld&) = delete;
    SoftWorld& operator=(const SoftWorld&) = delete;

    /// Adds a rigid body that takes over its shape.
    btRigidBody& addRigid(btCollisionShape* shape, const RigidSettings& settings = {});

    /// Keeps a shape, such as a compound's child, until the world is gone.
    btCollisionShape* keep(btCollisionShape* shape);

    /// The plane z = height [m].
    btRigidBody& addPlane(btScalar height = 0);

    /// A static box of 100 x 100 x 2 m with its upper face at z = height [m].
    btRigidBody& addFloorBox(btScalar height = 0);

    /// Takes the body over and adds it to the world.
    btSoftBody& addSoft(btSoftBody* body);

    void deleteSoft(btSoftBody& body);
    void deleteRigid(btRigidBody& body);

    /// Steps of exactly `h` [s], no sub-steps.
    void step(int count = 1, btScalar h = kStep);

    btSoftRigidDynamicsWorld& world() { return *m_world; }
    btSoftBodyWorldInfo& info() { return m_world->getWorldInfo(); }

private:
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    std::unique_ptr<btSoftRigidDynamicsWorld> m_world;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<btSoftBody*> m_soft;
    std::vector<btRigidBody*> m_rigid;
    std::unique_ptr<btFemConstraintSolver> m_coupledSolver;  // in place of m_rigidSolver; null if not coupled
};

/// A placement without rotation.
btTransform at(btScalar x, btScalar y, btScalar z);

}  // namespace bullet_fem
