// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/constraints/contact_rows.h"
#include "fem/contact/solver/anderson_acceleration.h"
#include "fem/contact/solver/coarse_correction.h"
#include "fem/contact/solver/joint_system.h"
#include "fem/contact/solver/sweep_parts.h"
#include "fem/contact/solver/truncated_newton.h"

namespace bullet_fem
{

/// Projected Gauss-Seidel over rows whose bodies all have a dense compliance: over the working set of rows with load,
/// after coarse correction, with Anderson acceleration; the joints are solved after each sweep. Grows with the problem,
/// never shrinks.
class ProjectedGaussSeidel
{
public:
    /// Both must outlive it.
    ProjectedGaussSeidel(ContactRows& rows, JointSystem& joints)
        : m_rows(rows), m_joints(joints), m_mixing(rows), m_coarse(rows), m_newton(rows, joints)
    {
    }

    /// Call when the rows are assembled anew.
    void begin();

    /// Call when the rows' velocities are measured anew: drops the working set.
    void restart();

    /// Call after the rows have marked what they require.
    void noteLooked() { m_looked = true; }

    /// Call after rows of others have changed the rigid proxies' velocities.
    void othersMoved()
    {
        m_looked = false;
        m_newton.restart();
    }

    /// See ContactSweeps.
    bool sweep(double tolerance);

    /// Call after the last sweep of an outer iteration: corrects the coarse level of the working set.
    void end();

    /// Change by the last sweep, relative to the speed scale, and as a speed [m/s].
    double lastChange() const { return m_lastChange; }
    double lastSpeed() const { return m_lastSpeed; }

private:
    void divideRows();
    void chooseWorkingSet();
    bool needsNone() const;
    void lookForWork();
    bool restIsDone(double tolerance);
    void sweepAll();
    double sweepRows(Range rows);
    double sweepOnce(Range rows);
    int endOfPair(int begin, int end) const;

    ContactRows& m_rows;
    JointSystem& m_joints;
    AndersonAcceleration m_mixing;
    CoarseCorrection m_coarse;
    TruncatedNewton m_newton;
    SweepParts m_parts;                  // parts of the rows
    std::vector<int> m_working;          // rows of the working set, part by part
    std::vector<unsigned char> m_works;  // per row: in the working set
    bool m_needsNone = false;            // no row is swept by itself
    bool m_looked = false;               // the rows' marks are up to date
    int m_lifeOfSet = -1;                // sweeps until another is chosen; -1: there is none
    bool m_hasSwept = false;             // a sweep was made since the restart
    double m_negligible = 0;             // change below which a row waits [m/s]
    double m_lastChange = 0, m_lastSpeed = 0;
};

}  // namespace bullet_fem
