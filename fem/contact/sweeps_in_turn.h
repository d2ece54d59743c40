// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/contact_rows.h"
#include "fem/contact/subspace_search.h"
#include "fem/contact/sweep_parts.h"

namespace bullet_fem
{

/// Gauss-Seidel over rows whose bodies all have a dense compliance: over those that carry something, the working set,
/// with subspace minimizations between. Grows with the problem, never shrinks.
class SweepsInTurn
{
public:
    /// The rows must outlive it.
    explicit SweepsInTurn(ContactRows& rows) : m_rows(rows), m_subspace(rows) {}

    /// When the rows are assembled anew.
    void begin();

    /// When the rows' velocities are measured anew.
    void restart();

    /// When all that sweeps have found out is to be forgotten.
    void reset();

    /// Rows of others have changed the obstacles' velocities since the last sweep.
    void othersMoved() { m_looked = false; }

    /// See ContactSweeps.
    bool sweep(double tolerance);

    /// What the last sweep changed, as a share of the speed scale, and as a speed [m/s].
    double lastChange() const { return m_lastChange; }
    double lastSpeed() const { return m_lastSpeed; }

private:
    struct Swept  // what a sweep over some rows has changed
    {
        double m_largest = 0;  // [m/s]
        double m_work = 0;     // roughly [J]
    };

    void divideRows();
    void forgetWorkingSet();
    void chooseWorkingSet();
    void lookForWork();
    bool restIsDone(double tolerance);
    void sweepAll();
    Swept sweepRows(Range rows);
    Swept sweepOnce(Range rows);
    int endOfPair(int begin, int end) const;

    ContactRows& m_rows;
    SubspaceSearch m_subspace;
    SweepParts m_parts;                  // of the rows
    std::vector<int> m_working;          // rows that the sweeps are over, part by part
    std::vector<unsigned char> m_works;  // per row: belongs to them
    std::vector<unsigned char> m_wants;  // per row: is to belong to the next, if it has been looked for
    bool m_looked = false;               // and nothing has changed since
    int m_lifeOfSet = -1;                // sweeps until another is chosen; -1: there is none
    double m_lastChange = 0, m_lastSpeed = 0;
};

}  // namespace bullet_fem
