// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/benchmark_world.h"

namespace bullet_fem
{

/// A crowd that is dropped into a pit.
struct CrowdSettings
{
    int m_bodies = 100;        ///< soft bodies of about 1,000 tets, in [1, 2000]
    int m_balls = 20;          ///< rigid balls, in [0, 2000]
    bool m_cubes = false;      ///< soft cubes, which rest on whole faces, instead of soft balls
    bool m_different = false;  ///< soft bodies of different sizes, meshes and stiffness, so that no factor is shared
    double m_contactTolerance = btFemSolverInfo().m_contactTolerance;  ///< of the solver [-], in [1e-7, 0.1]
    int m_threads = 1;                                                 ///< of the solver, in [0, 256]
    bool m_coupled = false;  ///< monolithic: btFemConstraintSolver instead of Bullet's rigid solver
};

/// Results of one step of a crowd.
struct CrowdStep : BenchmarkReport
{
    double m_milliseconds = 0;     ///< wall time of the whole step [ms]; that of free motion is divided by the threads
    double m_cpuMilliseconds = 0;  ///< processor time of the calling thread [ms]
};

/// Soft balls or cubes of about 0.2 m and rigid balls of 0.18 m, initially on a lattice above a pit of static boxes.
/// All bodies are factored before the first step.
class CrowdWorld
{
public:
    explicit CrowdWorld(const CrowdSettings& settings);

    /// Makes one step of 1/60 s.
    CrowdStep step();

    /// Allows or forbids sleeping. Initially it is forbidden.
    void allowSleep(bool allowed);

    int tetCount() const { return m_world.tetCount(); }
    double setupSeconds() const { return m_world.setupSeconds(); }  ///< over all soft bodies [s]

private:
    void addBox(const btVector3& center, const btVector3& halfExtents);
    void addPit(btScalar halfWidth);
    void addBall(const btVector3& center);
    void addSoft(const btVector3& center, int index);

    CrowdSettings m_settings;
    const int m_threadCount;
    BenchmarkWorld m_world;
};

}  // namespace bullet_fem
