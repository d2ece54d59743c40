// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/solver/accelerated_projected_gradient.h"
#include "fem/contact/solver/projected_gauss_seidel.h"

namespace bullet_fem
{

/// Sweeps over rows, by the method that their bodies permit. Grows with the problem, never shrinks.
class ContactSweeps
{
public:
    /// The rows must outlive it.
    explicit ContactSweeps(ContactRows& rows)
        : m_rows(rows), m_joints(rows), m_inTurn(rows, m_joints), m_atOnce(rows, m_joints)
    {
    }

    /// Call when the rows are assembled anew.
    void begin();

    /// Updates the velocities of the rows' sides from the bodies' true ones.
    void measure();

    /// Surveys all rows after measure(): the next sweep need not search for rows that require a change.
    RowSurvey look();

    /// The joints, which are solved in every sweep.
    JointSystem& joints() { return m_joints; }

    /// Drops the state of previous sweeps.
    void reset();

    /// Call after rows of others have changed the rigid proxies' velocities.
    void othersMoved() { m_inTurn.othersMoved(); }

    /// One sweep; the velocities of sides and rigid proxies follow. True if an impulse changed, or should change, by
    /// more than the tolerance, measured as the velocity of a row's own point over the scale; after a gradient step,
    /// which is one of many short ones, by a full step of every row alone.
    bool sweep(double tolerance);

    /// Call after the last sweep of an outer iteration: corrects the remaining error on the coarse level.
    void end() { m_inTurn.end(); }

    /// True if the last sweep diverged.
    bool runsAway() const;

    /// Removes the impulses on all diverging bodies and rigid proxies, and releases these for the rest of the step.
    void letGo();

    /// Change by the last Gauss-Seidel sweep relative to the scale; 0 after a gradient step, whose short steps need not
    /// shrink.
    double lastChange() const { return m_rows.isDense() ? m_inTurn.lastChange() : 0; }

private:
    ContactRows& m_rows;
    JointSystem m_joints;
    ProjectedGaussSeidel m_inTurn;
    AcceleratedProjectedGradient m_atOnce;
    std::vector<unsigned char> m_runaways;  // per mover of the rows: it is released
};

}  // namespace bullet_fem
