// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>

#include "benchmarks/benchmark_world.h"

namespace bullet_fem
{

/// How a game steps.
struct GameSettings
{
    BenchmarkLine m_line = BenchmarkLine::swap;
    double m_contactTolerance = btFemSolverInfo().m_contactTolerance;  ///< [-], in [1e-7, 0.1]
    int m_subSteps = 1;                                                ///< of a frame of 1/60 s, >= 1
};

/// What one frame took and did: times are sums over its sub-steps, other reports the largest of them.
struct GameFrame : BenchmarkReport
{
    double m_milliseconds = 0;  ///< processor time of the whole frame [ms]
    double m_held = 0;          ///< upward force of all contacts and anchors on soft bodies, mean [N]
};

/// A world that is stepped frame by frame, on one thread.
class Game
{
public:
    virtual ~Game() = default;

    /// A frame of 1/60 s.
    virtual GameFrame step() = 0;
    virtual int tetCount() const = 0;                   ///< of all soft bodies
    virtual double softWeight() const = 0;              ///< [N]
    virtual std::string outcome() const { return {}; }  ///< what has become of the scene by now; may be empty
};

/// Upward force of contacts and anchors between soft bodies and others in a step of h [s], N.
double heldIn(const btFemSoftBodySolver& fem, const std::vector<std::unique_ptr<btSoftBody>>& bodies, double h);

double massOf(const std::vector<std::unique_ptr<btSoftBody>>& bodies);  ///< [kg]

/// Adds a step's reports to those of its frame.
void add(const BenchmarkReport& step, GameFrame& frame);

/// A game's btSoftRigidDynamicsWorld; gravity along -y.
class GameWorld : public Game
{
public:
    explicit GameWorld(const GameSettings& settings, double gravity = 9.81);

    /// A rigid body that takes over its shape; mass 0 [kg] is static.
    btRigidBody& addRigid(btCollisionShape* shape, double mass, const btVector3& position, double friction)
    {
        return m_world.addRigid(shape, mass, position, friction);
    }
    /// Takes the body over.
    btSoftBody& addSoft(btSoftBody* body, double youngModulus, double density, double friction);
    /// The same with the material and friction that it has.
    btSoftBody& addSoft(btSoftBody* body);
    /// Takes the joint over.
    void addJoint(btTypedConstraint* joint) { m_world.addJoint(joint); }
    void keep(std::shared_ptr<void> object) { m_world.keep(std::move(object)); }

    /// What is done before every frame that begins at this time [s].
    void setDrive(std::function<void(GameWorld&, double time)> drive) { m_drive = std::move(drive); }
    /// What outcome() says.
    void setOutcome(std::function<std::string(const GameWorld&)> outcome) { m_outcome = std::move(outcome); }

    GameFrame step() override;
    int tetCount() const override { return m_world.tetCount(); }
    double softWeight() const override;
    std::string outcome() const override { return m_outcome ? m_outcome(*this) : std::string(); }

    btSoftBodyWorldInfo& info() { return m_world.bullet().getWorldInfo(); }
    const BenchmarkWorld& world() const { return m_world; }

private:
    GameSettings m_settings;
    double m_gravity;  // [m/s2]
    BenchmarkWorld m_world;
    std::function<void(GameWorld&, double)> m_drive;
    std::function<std::string(const GameWorld&)> m_outcome;
    int m_frames = 0;
};

}  // namespace bullet_fem
