// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "fem/contact/contact_rows.h"

namespace bullet_fem
{

/// Anderson's acceleration of sweeps [Walker & Ni 2011]: a sweep starts from that mix of the results of the last three
/// whose changes cancel as far as they can. Loads that sweeps would hand on from point to point a hundred times spread
/// in some ten. The velocities of bodies are mixed like the impulses, and nothing of W is needed. Grows with the rows,
/// never shrinks.
class AndersonAcceleration
{
public:
    /// The rows must outlive it.
    explicit AndersonAcceleration(ContactRows& rows) : m_rows(rows) {}

    /// When the rows are assembled anew.
    void begin();

    /// Forgets all sweeps: they are over these rows from now on, and their bodies' working sets.
    void start(const std::vector<int>& working);

    /// Before a sweep over them. Impulses may leave their cones; the sweep takes them back.
    void mix(const std::vector<int>& working);

    /// After it.
    void note(const std::vector<int>& working);

    /// Instead, of a sweep that runs away: all is again as it was before the mix, and nothing is mixed until another
    /// start. False if nothing was mixed.
    bool takeBack(const std::vector<int>& working);

private:
    struct Swept  // of a row, by the last sweep, and its differences from those before
    {
        Vec3 m_after, m_change;
        Vec3 m_afterDelta[WorkingSet::kMixed], m_changeDelta[WorkingSet::kMixed];
    };
    void addShares(const std::vector<int>& working);
    double squareOfChanges(const std::vector<int>& working) const;
    void noteRows(const std::vector<int>& working, bool first);
    void chooseShares(const std::vector<int>& working);

    ContactRows& m_rows;
    std::vector<Vec3> m_before;  // impulses of the rows as the last sweep began
    std::vector<Swept> m_swept;  // of the same rows
    std::array<double, WorkingSet::kMixed> m_shares{};
    int m_slot = 0;       // of the newest differences
    double m_square = 0;  // of the last sweep's changes, roughly [J]; 0: there is none
    bool m_trusted = true;
};

}  // namespace bullet_fem
