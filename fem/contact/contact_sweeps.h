// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/accelerated_projected_gradient.h"
#include "fem/contact/projected_gauss_seidel.h"

namespace bullet_fem
{

/// Sweeps over rows, of the kind that their bodies allow. Grows with the problem, never shrinks.
class ContactSweeps
{
public:
    /// The rows must outlive it.
    explicit ContactSweeps(ContactRows& rows)
        : m_rows(rows), m_joints(rows), m_inTurn(rows, m_joints), m_atOnce(rows, m_joints)
    {
    }

    /// When the rows are assembled anew.
    void begin();

    /// Brings the velocities of the rows' ends up to the bodies' true ones.
    void measure();

    /// Looks at all rows, which have just been measured: the next sweep need not look for those that want something.
    RowSurvey look();

    /// Joints are solved in every sweep.
    JointSystem& joints() { return m_joints; }

    /// Forgets all that sweeps have found out.
    void reset();

    /// Rows of others have changed the rigid proxies' velocities since the last sweep.
    void othersMoved() { m_inTurn.othersMoved(); }

    /// One sweep; the velocities of ends and rigid proxies follow. True if an impulse changed, or is to change, by more
    /// than the tolerance: the speed that it gives a row's own point over the scale; after a gradient step, of which
    /// many short ones make up a way, what a whole step of every row alone would still change.
    bool sweep(double tolerance);

    /// After the last sweep of a round: what they leave of the coarse level is corrected.
    void end() { m_inTurn.end(); }

    /// True if the last sweep changed a velocity by so much that sweeping leads nowhere.
    bool runsAway() const;

    /// Takes back the impulses on all bodies and rigid proxies that run away, and holds them no more in this step.
    void letGo();

    /// What the last sweep in turn changed, as a share of the scale; 0 of one at once, whose short steps need not
    /// shrink.
    double lastChange() const { return m_rows.isDense() ? m_inTurn.lastChange() : 0; }

private:
    ContactRows& m_rows;
    JointSystem m_joints;
    ProjectedGaussSeidel m_inTurn;
    AcceleratedProjectedGradient m_atOnce;
    std::vector<unsigned char> m_runaways;  // per mover of the rows: is being let go
};

}  // namespace bullet_fem
