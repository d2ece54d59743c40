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
#include "bullet_fem/btFemSoftBodySolver.h"

class btDeformableGravityForce;

namespace bullet_fem
{

constexpr btScalar kStep = btScalar(1) / 60;  ///< default time step [s]
constexpr double kGravity = 9.81;             ///< [m/s2], along -z

/// Initial state of a rigid body.
struct RigidSettings
{
    btScalar m_mass = 0;  ///< [kg]; 0 is static
    btTransform m_transform = btTransform::getIdentity();
    btScalar m_friction = 1;        ///< [-]
    btVector3 m_velocity{0, 0, 0};  ///< [m/s]
    btVector3 m_spin{0, 0, 0};      ///< [rad/s]
};

/// Settings with implicit Euler in free motion, too, so that bodies without material damping settle.
inline btFemSolverInfo implicitEuler()
{
    btFemSolverInfo info;
    info.m_numericalDamping = info.m_contactDamping = 1;
    return info;
}

/// The coupling with the rigid solver.
enum class Coupling
{
    swap,    ///< staggered: Bullet's own solver runs first, reactions of the soft bodies act afterwards
    coupled  ///< monolithic: a btFemConstraintSolver solves rigid and soft bodies together
};

/// The coupling's name in test names.
inline const char* couplingName(Coupling coupling)
{
    return coupling == Coupling::swap ? "swap" : "coupled";
}

/// Bullet's worlds with soft bodies, by the names of their classes.
enum class WorldClass
{
    softRigid,
    softMultiBody,
    deformable  ///< its soft body solver is a btDeformableBodySolver
};

/// The world's name in test names.
inline const char* worldName(WorldClass worldClass)
{
    return worldClass == WorldClass::softRigid       ? "softRigid"
           : worldClass == WorldClass::softMultiBody ? "softMultiBody"
                                                     : "deformable";
}

/// One of Bullet's worlds, a btSoftRigidDynamicsWorld by default, that owns its bodies, their shapes and motion states.
/// Gravity is along -z, for rigid and soft bodies alike; bodies do not sleep.
class SoftWorld
{
public:
    /// The solver must outlive the world, and match its class.
    explicit SoftWorld(btSoftBodySolver& solver, const btVector3& gravity = {0, 0, btScalar(-kGravity)});
    SoftWorld(WorldClass worldClass, btSoftBodySolver& solver, const btVector3& gravity = {0, 0, btScalar(-kGravity)});
    SoftWorld(btFemSoftBodySolver& solver, Coupling coupling, const btVector3& gravity = {0, 0, btScalar(-kGravity)});
    ~SoftWorld();
    SoftWorld(const SoftWorld&) = delete;
    SoftWorld& operator=(const SoftWorld&) = delete;

    /// Adds a rigid body and takes ownership of its shape.
    btRigidBody& addRigid(btCollisionShape* shape, const RigidSettings& settings = {});

    /// Owns a shape, such as a compound's child, until the world is deleted.
    btCollisionShape* keep(btCollisionShape* shape);

    /// The plane z = height [m].
    btRigidBody& addPlane(btScalar height = 0);

    /// A static box of 100 x 100 x 2 m with its upper face at z = height [m].
    btRigidBody& addFloorBox(btScalar height = 0);

    /// Takes ownership of the body and adds it to the world.
    btSoftBody& addSoft(btSoftBody* body);

    /// Adds a body owned by the caller, or one that was taken out before, to the world.
    void put(btSoftBody& body, int group = btBroadphaseProxy::DefaultFilter, int mask = btBroadphaseProxy::AllFilter);
    void take(btSoftBody& body);  ///< removes the body without deleting it

    void deleteSoft(btSoftBody& body);
    void deleteRigid(btRigidBody& body);

    /// Makes steps of exactly `h` [s], without sub-steps.
    void step(int count = 1, btScalar h = kStep);

    /// Sets gravity of all present and future soft bodies [m/s2].
    void setSoftGravity(const btVector3& gravity);

    btDiscreteDynamicsWorld& bullet() { return *m_world; }  ///< of any class
    btSoftRigidDynamicsWorld& world() { return dynamic_cast<btSoftRigidDynamicsWorld&>(*m_world); }
    btSoftBodyWorldInfo& info() { return *m_info; }
    btAlignedObjectArray<btSoftBody*>& softBodies() { return *m_inWorld; }

protected:
    void couple(btFemSoftBodySolver& solver);

private:
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    std::unique_ptr<btSequentialImpulseConstraintSolver> m_rigidSolver;
    std::unique_ptr<btDeformableGravityForce> m_gravityForce;  // of a deformable world
    std::unique_ptr<btDiscreteDynamicsWorld> m_world;
    btSoftBodyWorldInfo* m_info = nullptr;                   // the world's
    btAlignedObjectArray<btSoftBody*>* m_inWorld = nullptr;  // the world's
    const WorldClass m_class;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<btSoftBody*> m_soft;
    std::vector<btRigidBody*> m_rigid;
    std::unique_ptr<btFemConstraintSolver> m_coupledSolver;  // in place of m_rigidSolver; null if not coupled
};

/// The FEM solver for a class of worlds.
class FemSolverOf
{
protected:
    FemSolverOf(WorldClass worldClass, const btFemSolverInfo& info);
    ~FemSolverOf();

    std::unique_ptr<btSoftBodySolver> m_solver;
    btFemSoftBodySolver* m_fem;
};

/// A world of any class with its FEM solver, for tests over all classes. In a deformable world gravity is Bullet's
/// btDeformableGravityForce on all soft bodies.
class FemWorld : private FemSolverOf, public SoftWorld
{
public:
    explicit FemWorld(WorldClass worldClass, const btVector3& gravity = {0, 0, btScalar(-kGravity)});
    /// `coupled` requires softRigid.
    FemWorld(WorldClass worldClass, Coupling coupling, const btVector3& gravity = {0, 0, btScalar(-kGravity)},
             const btFemSolverInfo& info = btFemSolverInfo());
    FemWorld(WorldClass worldClass, const btFemSolverInfo& info,
             const btVector3& gravity = {0, 0, btScalar(-kGravity)});

    btFemSoftBodySolver& fem() { return *m_fem; }
    const btFemSoftBodySolver& fem() const { return *m_fem; }
};

/// A transform without rotation.
btTransform at(btScalar x, btScalar y, btScalar z);

}  // namespace bullet_fem
