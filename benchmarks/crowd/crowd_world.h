// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "bullet_fem/btFemSoftBodySolver.h"

namespace bullet_fem
{

/// A crowd to be dropped into a pit.
struct CrowdSettings
{
    int m_bodies = 100;        ///< soft ones of about 1,000 tets, in [1, 2000]
    int m_balls = 20;          ///< rigid ones, in [0, 2000]
    bool m_cubes = false;      ///< soft cubes, which rest on whole faces, in place of soft balls
    bool m_different = false;  ///< soft bodies of different sizes, meshes and stiffness, so that nothing is shared
    double m_contactTolerance = btFemSolverInfo().m_contactTolerance;  ///< of the solver [-], in [1e-7, 0.1]
    int m_threads = 1;                                                 ///< of the solver, in [0, 256]
    bool m_coupled = false;  ///< btFemConstraintSolver in place of Bullet's rigid solver
};

/// What one step of a crowd took and did.
struct CrowdStep
{
    double m_milliseconds = 0;         ///< wall time of the whole step [ms]
    double m_freeMilliseconds = 0;     ///< of the elastic solves without contact, all bodies, over the threads [ms]
    double m_contactMilliseconds = 0;  ///< of contact: search of surfaces, sweeps, corrective solves, all groups [ms]
    int m_contacts = 0;                ///< contact points of all bodies; between soft bodies they count for both
    int m_sweeps = 0;                  ///< of the group with the most
    int m_correctiveIterations = 0;    ///< of the group with the most
    int m_asleep = 0;                  ///< soft bodies
    double m_closingSpeed = 0;         ///< largest at which a contact point still closes [m/s]
    double m_deepest = 0;              ///< largest penetration at the start of the step [m]
    int m_flags = 0;                   ///< btFemFlags of all bodies
};

/// Soft balls or cubes of about 0.2 m and rigid balls of 0.18 m, on a lattice above a pit of static boxes, in a
/// btSoftRigidDynamicsWorld. All is factored before the first step.
class CrowdWorld
{
public:
    explicit CrowdWorld(const CrowdSettings& settings);
    ~CrowdWorld();
    CrowdWorld(const CrowdWorld&) = delete;
    CrowdWorld& operator=(const CrowdWorld&) = delete;

    /// One step of 1/60 s.
    CrowdStep step();

    /// Whether bodies at rest may fall asleep; not, unless called.
    void allowSleep(bool allowed);

    int tetCount() const;
    double setupSeconds() const { return m_setupSeconds; }  ///< of all soft bodies [s]

private:
    void addBox(const btVector3& center, const btVector3& halfExtents);
    void addPit(btScalar halfWidth);
    void addBall(const btVector3& center);
    void addSoft(const btVector3& center, int index);
    void addRigid(std::unique_ptr<btCollisionShape> shape, const btVector3& center, btScalar mass);

    CrowdSettings m_settings;
    const int m_threadCount;
    btFemSoftBodySolver m_fem;
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    std::unique_ptr<btSequentialImpulseConstraintSolver> m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigid;
    std::vector<std::unique_ptr<btSoftBody>> m_soft;
    std::vector<double> m_groupTimes;  // scratch of step()
    double m_setupSeconds = 0;
};

}  // namespace bullet_fem
