// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/anderson_acceleration.h"
#include "fem/contact/coarse_correction.h"
#include "fem/contact/contact_rows.h"
#include "fem/contact/joint_system.h"
#include "fem/contact/sweep_parts.h"

namespace bullet_fem
{

/// Gauss-Seidel over rows whose bodies all have a dense compliance: over those that carry something, the working set,
/// from what the coarse level has corrected, mixed by Anderson's acceleration; behind them the joints are solved. Grows
/// with the problem, never shrinks.
class ProjectedGaussSeidel
{
public:
    /// Both must outlive it.
    ProjectedGaussSeidel(ContactRows& rows, JointSystem& joints)
        : m_rows(rows), m_joints(joints), m_mixing(rows), m_coarse(rows)
    {
    }

    /// When the rows are assembled anew.
    void begin();

    /// When the rows' velocities are measured anew: forgets the working set.
    void restart();

    /// The rows have noted what they want.
    void noteLooked() { m_looked = true; }

    /// Rows of others have changed the rigid proxies' velocities since the last sweep.
    void othersMoved() { m_looked = false; }

    /// See ContactSweeps.
    bool sweep(double tolerance);

    /// After the last sweep of a round, where there was any: corrects the coarse level of what it was over.
    void end();

    /// What the last sweep changed, as a share of the speed scale, and as a speed [m/s].
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
    SweepParts m_parts;                  // of the rows
    std::vector<int> m_working;          // rows that the sweeps are over, part by part
    std::vector<unsigned char> m_works;  // per row: belongs to them
    bool m_needsNone = false;            // no row is swept by itself
    bool m_looked = false;               // the rows have noted what they want, and nothing has changed since
    int m_lifeOfSet = -1;                // sweeps until another is chosen; -1: there is none
    bool m_hasSwept = false;             // since the restart
    double m_negligible = 0;             // change of a row that waits [m/s]
    double m_lastChange = 0, m_lastSpeed = 0;
};

}  // namespace bullet_fem
