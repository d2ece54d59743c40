// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>

#include "benchmarks/benchmark_world.h"

namespace bullet_fem
{

/// Settings of the time stepping.
struct GameSettings
{
    BenchmarkLine m_line = BenchmarkLine::swap;
    double m_contactTolerance = btFemSolverInfo().m_contactTolerance;  ///< [-], in [1e-7, 0.1]
    int m_subSteps = 1;                                                ///< per frame of 1/60 s, >= 1
};

/// Results of one frame: times are sums over its sub-steps, other values their maximum.
struct GameFrame : BenchmarkReport
{
    double m_milliseconds = 0;  ///< processor time of the whole frame [ms]
    double m_held = 0;          ///< upward force of all contacts and anchors on soft bodies, mean over the frame [N]
};

/// A world that is stepped by frames, on one thread.
class Game
{
public:
    virtual ~Game() = default;

    /// Makes a frame of 1/60 s.
    virtual GameFrame step() = 0;
    virtual int tetCount() const = 0;                   ///< over all soft bodies
    virtual double softWeight() const = 0;              ///< total weight of the soft bodies [N]
    virtual std::string outcome() const { return {}; }  ///< the present result as a sentence; may be empty
};

/// Upward force of contacts and anchors on soft bodies by other bodies in a step of h [s], in N.
double heldIn(const btFemSoftBodySolver& fem, const std::vector<std::unique_ptr<btSoftBody>>& bodies, double h);

double massOf(const std::vector<std::unique_ptr<btSoftBody>>& bodies);  ///< [kg]

/// Adds a step's report to that of its frame.
void add(const BenchmarkReport& step, GameFrame& frame);

/// A game in a btSoftRigidDynamicsWorld; gravity along -y.
class GameWorld : public Game
{
public:
    explicit GameWorld(const GameSettings& settings, double gravity = 9.81);

    /// Adds a rigid body and takes ownership of its shape; mass 0 [kg]: static.
    btRigidBody& addRigid(btCollisionShape* shape, double mass, const btVector3& position, double friction)
    {
        return m_world.addRigid(shape, mass, position, friction);
    }
    /// Takes ownership of the body.
    btSoftBody& addSoft(btSoftBody* body, double youngModulus, double density, double friction);
    /// Takes ownership of the body; keeps its material and friction.
    btSoftBody& addSoft(btSoftBody* body);
    /// Takes ownership of the joint.
    void addJoint(btTypedConstraint* joint) { m_world.addJoint(joint); }
    void keep(std::shared_ptr<void> object) { m_world.keep(std::move(object)); }

    /// Sets a function that is called before each frame with the time of its start [s].
    void setDrive(std::function<void(GameWorld&, double time)> drive) { m_drive = std::move(drive); }
    /// Sets the function that gives outcome().
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
