// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/contact_rows.h"
#include "fem/contact/joint_system.h"

namespace bullet_fem
{

/// Accelerated projected gradient steps on all rows at the same time: where a body has no dense compliance, and is
/// solved for what all impulses do to it together; behind a step the joints are solved. Grows with the problem, never
/// shrinks.
class AcceleratedProjectedGradient
{
public:
    /// Both must outlive it.
    AcceleratedProjectedGradient(ContactRows& rows, JointSystem& joints) : m_rows(rows), m_joints(joints) {}

    /// When the rows are assembled anew.
    void begin();

    /// Forgets the directions of the last sweeps.
    void restart();

    /// See ContactSweeps.
    bool sweep(double tolerance);

    /// The largest change by the last one, of a row's own point [m/s].
    double lastSpeed() const { return m_lastSpeed; }

private:
    struct Memory  // of one row
    {
        Vec3 m_impulse, m_velocity;  // before the last sweep
        Vec3 m_next;                 // impulse that it is to have
    };

    void chooseStep();
    double sumOfSquares() const;
    void probe(double unit);

    ContactRows& m_rows;
    JointSystem& m_joints;
    std::vector<Memory> m_memory;
    double m_step = 0;  // of the gradient; 0: not chosen yet
    double m_acceleration = 1;
    double m_lastSpeed = 0;
};

}  // namespace bullet_fem
