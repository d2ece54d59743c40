// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/btFemInterest.h"
#include "python/core/body_table.h"
#include "python/core/bullet_world.h"
#include "python/core/mesh.h"
#include "python/core/step_guard.h"

namespace bullet_fem::python
{

class Robot;

/// A joint of rigid bodies.
struct JointEntry
{
    std::unique_ptr<btTypedConstraint> m_constraint;  ///< empty if it was removed
    int m_a = -1, m_b = -1;                           ///< indices of its bodies; -1: the world
};

/// A world with its bodies and joints, known by indices that are never used again. Not copied, as its members are not.
class World
{
public:
    /// `factorsInBackground`: the solver has a thread for it.
    World(std::unique_ptr<BulletWorld> bullet, double step, bool factorsInBackground);
    ~World();

    /// Leave their argument alone if they throw.
    int add(std::unique_ptr<SoftEntry>&& soft, const std::string& name, int group, int mask);
    int add(std::unique_ptr<RigidEntry>&& rigid, const std::string& name, int group, int mask);
    int add(JointEntry joint, bool bodiesCollide);
    void removeBody(int index);
    void removeJoint(int index);
    void setGravity(const btVector3& gravity);
    /// Null removes it.
    void setInterest(std::unique_ptr<btFemInterest> interest);

    /// Throws std::runtime_error if the joint was removed.
    JointEntry& joint(int index);

    const BodyTable& bodies() const { return m_bodies; }
    const std::vector<JointEntry>& joints() const { return m_joints; }
    BulletWorld& bullet() { return *m_bullet; }
    btFemSoftBodySolver& fem() { return m_bullet->fem(); }
    StepGuard& guard() { return m_guard; }
    double stepSize() const { return m_step; }
    long steps() const { return m_steps; }
    /// One step, without Python's lock.
    void step();
    /// To be called after each step.
    void finishStep();

private:
    friend struct WorldRobots;
    friend struct WorldState;
    void registerScene();

    std::unique_ptr<btFemInterest> m_interest;
    std::unique_ptr<BulletWorld> m_bullet;
    const double m_step;  // [s]
    long m_steps = 0;
    BodyTable m_bodies;
    std::vector<JointEntry> m_joints;
    StepGuard m_guard;
    std::vector<std::unique_ptr<Robot>> m_robots;
};

}  // namespace bullet_fem::python
