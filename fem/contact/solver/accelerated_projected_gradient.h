// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/constraints/contact_rows.h"
#include "fem/contact/solver/joint_system.h"

namespace bullet_fem
{

/// Accelerated projected gradient steps on all rows simultaneously, for bodies without a dense compliance, which are
/// solved for all impulses together; the joints are solved after each step. Grows with the problem, never shrinks.
class AcceleratedProjectedGradient
{
public:
    /// Both must outlive it.
    AcceleratedProjectedGradient(ContactRows& rows, JointSystem& joints) : m_rows(rows), m_joints(joints) {}

    /// Call when the rows are assembled anew.
    void begin();

    /// Forgets the directions of the last sweeps.
    void restart();

    /// See ContactSweeps.
    bool sweep(double tolerance);

    /// Largest velocity change of a row's own point by the last sweep [m/s].
    double lastSpeed() const { return m_lastSpeed; }

private:
    struct Memory  // data of one row
    {
        Vec3 m_impulse, m_velocity;  // before the last sweep
        Vec3 m_next;                 // next impulse
    };

    void chooseStep();
    double sumOfSquares() const;
    void probe(double unit);

    ContactRows& m_rows;
    JointSystem& m_joints;
    std::vector<Memory> m_memory;
    double m_step = 0;  // step size; 0: not chosen yet
    double m_acceleration = 1;
    double m_lastSpeed = 0;
};

}  // namespace bullet_fem
