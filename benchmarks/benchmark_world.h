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

/// What the reports of all soft bodies tell of a step.
struct BenchmarkReport
{
    double m_freeMilliseconds = 0;     ///< of the elastic solves without contact, all bodies [ms]
    double m_contactMilliseconds = 0;  ///< of contacts and joints, all groups [ms]
    int m_contacts = 0;                ///< contact points of all bodies; between soft bodies they count for both
    int m_sweeps = 0;                  ///< of the group with the most
    int m_correctiveIterations = 0;    ///< of the group with the most
    int m_asleep = 0;                  ///< soft bodies
    double m_closingSpeed = 0;         ///< largest at which a contact point still closes [m/s]
    double m_deepest = 0;              ///< largest penetration at the start of the step [m]
    int m_flags = 0;                   ///< btFemFlags of all bodies
};

/// Who moves the bodies of a world.
enum class BenchmarkLine
{
    swap,     ///< BulletFEM the soft bodies, Bullet's rigid solver the rigid ones
    coupled,  ///< BulletFEM's constraint solver both together
    bullet    ///< Bullet all of them: there are no reports then
};

/// The sum of the reports of these bodies' last step.
BenchmarkReport sumReports(const btFemSoftBodySolver& fem, const std::vector<std::unique_ptr<btSoftBody>>& bodies);

/// A btSoftRigidDynamicsWorld whose soft bodies are FEM, and which owns its bodies, their shapes and joints.
class BenchmarkWorld
{
public:
    BenchmarkWorld(const btFemSolverInfo& info, BenchmarkLine line, const btVector3& gravity);
    ~BenchmarkWorld();
    BenchmarkWorld(const BenchmarkWorld&) = delete;
    BenchmarkWorld& operator=(const BenchmarkWorld&) = delete;

    /// A rigid body that takes over its shape; mass 0 [kg] is static.
    btRigidBody& addRigid(btCollisionShape* shape, double mass, const btVector3& position, double friction);
    /// Takes the body over, and factors it for steps of `step` [s].
    btSoftBody& addSoft(btSoftBody* body, const btFemMaterial& material, double friction, double step);
    /// The same with the material and friction that Bullet's program gave it.
    btSoftBody& addSoft(btSoftBody* body, double step);
    /// Takes the joint over; its bodies do not touch each other.
    void addJoint(btTypedConstraint* joint);
    /// Holds what the world's shapes need for as long as they do.
    void keep(std::shared_ptr<void> object) { m_kept.push_back(std::move(object)); }

    BenchmarkReport report() const { return sumReports(m_fem, m_soft); }

    btSoftRigidDynamicsWorld& bullet() { return m_world; }
    const btFemSoftBodySolver& fem() const { return m_fem; }
    const std::vector<std::unique_ptr<btSoftBody>>& soft() const { return m_soft; }
    const std::vector<std::unique_ptr<btRigidBody>>& rigid() const { return m_rigid; }
    int tetCount() const;                                   ///< of all soft bodies
    double setupSeconds() const { return m_setupSeconds; }  ///< of all soft bodies [s]

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
