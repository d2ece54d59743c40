// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "LinearMath/btScalar.h"

class btMultiBody;

namespace bullet_fem
{

/// State of multibodies from step to step, and their velocities before Bullet's rigid solver; as RigidHistory for rigid
/// bodies, in joint coordinates.
class ArticulatedHistory
{
public:
    /// Call if velocities before Bullet's rigid solver contain the forces.
    void assumeForcesGiven() { m_forcesGiven = true; }

    /// Forgets velocities noted before the rigid solver, and the memory of multibodies that felt no impulse in the last
    /// step.
    void beginStep();

    /// Notes the velocity of a multibody before Bullet's rigid solver. Not thread-safe.
    void noteBeforeSolve(const btMultiBody& body);

    /// Reserves memory that a later step may need for a multibody, and for the velocities of all.
    void reserve(const btMultiBody& body, std::size_t bodies, std::size_t coordinates);

    /// Adds the support by contacts, motors and limits in `step` [s] to `freeVelocity`, all per coordinate. True if
    /// there was none: forces alone changed the velocity.
    bool addSupport(const btMultiBody& body, double step, const std::vector<double>& acceleration,
                    const double* velocity, double* freeVelocity);

    /// Adds a change to the multibody's velocity with a single rounding.
    void addVelocity(btMultiBody& body, const std::vector<btScalar>& change);

    /// Notes the velocity change by soft bodies.
    void noteGiven(const btMultiBody& body, const std::vector<btScalar>& change);

private:
    struct Before
    {
        const btMultiBody* m_body;
        std::size_t m_first;  // index in m_beforeVelocity
    };
    struct Memory
    {
        const btMultiBody* m_body = nullptr;  // compared, never followed; null: free
        bool m_used = false;                  // an impulse was applied in this step
        std::vector<double> m_given;  // velocity change by soft bodies in the last step, per coordinate [m/s], [rad/s]
        std::vector<double> m_remainder;  // rounding error of the velocity, per coordinate [m/s], [rad/s]
    };

    Memory& memoryOf(const btMultiBody& body);

    bool m_forcesGiven = false;  // forces are in the velocities of noteBeforeSolve()
    std::vector<Before> m_before;
    std::vector<double> m_beforeVelocity;
    std::vector<Memory> m_memories;
    std::vector<btScalar> m_rounded;  // scratch per coordinate
};

}  // namespace bullet_fem
