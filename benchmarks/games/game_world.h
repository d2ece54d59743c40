// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/benchmark_world.h"

namespace bullet_fem
{

/// How a game steps.
struct GameSettings
{
    bool m_coupled = false;  ///< btFemConstraintSolver in place of Bullet's rigid solver
    double m_contactTolerance = btFemSolverInfo().m_contactTolerance;  ///< [-], in [1e-7, 0.1]
    int m_subSteps = 1;                                                ///< of a frame of 1/60 s, >= 1
};

/// What one frame took and did: times are sums over its sub-steps, other reports the largest of them.
struct GameFrame : BenchmarkReport
{
    double m_milliseconds = 0;  ///< processor time of the whole frame [ms]
    double m_held = 0;          ///< upward force of all contacts and anchors on soft bodies, mean [N]
};

/// A game's world: one thread, gravity along -y.
class GameWorld
{
public:
    explicit GameWorld(const GameSettings& settings);

    /// A rigid body that takes over its shape; mass 0 [kg] is static.
    btRigidBody& addRigid(btCollisionShape* shape, double mass, const btVector3& position, double friction)
    {
        return m_world.addRigid(shape, mass, position, friction);
    }
    /// Takes the body over.
    btSoftBody& addSoft(btSoftBody* body, double youngModulus, double density, double friction);

    /// A frame of 1/60 s.
    GameFrame step();

    btSoftBodyWorldInfo& info() { return m_world.bullet().getWorldInfo(); }
    const BenchmarkWorld& world() const { return m_world; }
    double softWeight() const;  ///< [N]

private:
    double heldNow() const;

    GameSettings m_settings;
    BenchmarkWorld m_world;
};

}  // namespace bullet_fem
