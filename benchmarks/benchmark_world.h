// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <utility>
#include <vector>

#include "bullet_fem/btFemSoftBodySolver.h"

namespace bullet_fem
{

/// Summary of the reports of all soft bodies for one step.
struct BenchmarkReport
{
    double m_freeMilliseconds = 0;     ///< elastic solves without contact, all bodies [ms]
    double m_contactMilliseconds = 0;  ///< of contacts and joints, all groups [ms]
    int m_contacts = 0;                ///< contact points of all bodies; those between soft bodies count twice
    int m_sweeps = 0;                  ///< maximum over the groups
    int m_correctiveIterations = 0;    ///< maximum over the groups
    int m_asleep = 0;                  ///< number of sleeping soft bodies
    double m_closingSpeed = 0;         ///< largest remaining closing speed at a contact point [m/s]
    double m_deepest = 0;              ///< largest penetration at the start of the step [m]
    int m_flags = 0;                   ///< btFemFlags of all bodies, combined
};

/// Selects the solvers of a world.
enum class BenchmarkLine
{
    swap,     ///< staggered: BulletFEM moves soft bodies, Bullet's rigid solver rigid ones
    coupled,  ///< monolithic: BulletFEM's constraint solver moves both together
    bullet    ///< Bullet moves all bodies; there are no reports
};

/// Sums the reports of the last step of these bodies.
BenchmarkReport sumReports(const btFemSoftBodySolver& fem, const std::vector<std::unique_ptr<btSoftBody>>& bodies);

/// A btSoftRigidDynamicsWorld with FEM soft bodies. It owns its bodies, their shapes and joints.
class BenchmarkWorld
{
public:
    BenchmarkWorld(const btFemSolverInfo& info, BenchmarkLine line, const btVector3& gravity);
    ~BenchmarkWorld();
    BenchmarkWorld(const BenchmarkWorld&) = delete;
    BenchmarkWorld& operator=(const BenchmarkWorld&) = delete;

    /// Adds a rigid body and takes ownership of its shape; mass 0 [kg]: static.
    btRigidBody& addRigid(btCollisionShape* shape, double mass, const btVector3& position, double friction);
    /// Takes ownership of the body and factors it for steps of `step` [s].
    btSoftBody& addSoft(btSoftBody* body, const btFemMaterial& material, double friction, double step);
    /// Keeps the material and friction that the body already has in Bullet.
    btSoftBody& addSoft(btSoftBody* body, double step);
    /// Takes ownership of the joint; collisions between its bodies are disabled.
    void addJoint(btTypedConstraint* joint);
    /// Keeps an object alive as long as the world, for shapes that refer to it.
    void keep(std::shared_ptr<void> object) { m_kept.push_back(std::move(object)); }

    BenchmarkReport report() const { return sumReports(m_fem, m_soft); }

    btSoftRigidDynamicsWorld& bullet() { return m_world; }
    const btFemSoftBodySolver& fem() const { return m_fem; }
    const std::vector<std::unique_ptr<btSoftBody>>& soft() const { return m_soft; }
    const std::vector<std::unique_ptr<btRigidBody>>& rigid() const { return m_rigid; }
    int tetCount() const;                                   ///< over all soft bodies
    double setupSeconds() const { return m_setupSeconds; }  ///< over all soft bodies [s]

private:
    void prepare(btSoftBody& body, double step);

    const BenchmarkLine m_line;
    std::vector<std::shared_ptr<void>> m_kept;
    btFemSoftBodySolver m_fem;
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    std::unique_ptr<btSequentialImpulseConstraintSolver> m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigid;
    std::vector<std::unique_ptr<btSoftBody>> m_soft;
    std::vector<std::unique_ptr<btTypedConstraint>> m_joints;
    double m_setupSeconds = 0;
};

}  // namespace bullet_fem
