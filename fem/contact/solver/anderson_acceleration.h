// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "fem/contact/constraints/contact_rows.h"

namespace bullet_fem
{

/// Anderson acceleration of sweeps [Walker & Ni 2011]: a sweep starts from the linear combination of the last three
/// results whose changes cancel best. Loads that plain sweeps would spread over points in a hundred sweeps need some
/// ten. The velocities of bodies are combined like the impulses, without W. Grows with the rows, never shrinks.
class AndersonAcceleration
{
public:
    /// The rows must outlive it.
    explicit AndersonAcceleration(ContactRows& rows) : m_rows(rows) {}

    /// Call when the rows are assembled anew.
    void begin();

    /// Drops all previous sweeps: the next ones are over these rows and their bodies' working sets.
    void start(const std::vector<int>& working);

    /// Call before a sweep over them: combines previous results. Impulses may leave their cones; the sweep projects
    /// them.
    void mix(const std::vector<int>& working);

    /// Call after the sweep: stores its result.
    void note(const std::vector<int>& working);

    /// Call instead of note() after a diverging sweep: restores the state before the mix, and mixes nothing until
    /// another start. False if nothing was mixed.
    bool takeBack(const std::vector<int>& working);

private:
    struct Swept  // result of a row in the last sweep, and its differences from earlier ones
    {
        Vec3 m_after, m_change;
        Vec3 m_afterDelta[WorkingSet::kMixed], m_changeDelta[WorkingSet::kMixed];
    };
    void addShares(const std::vector<int>& working);
    double squareOfChanges(const std::vector<int>& working) const;
    void noteRows(const std::vector<int>& working, bool first);
    void chooseShares(const std::vector<int>& working);

    ContactRows& m_rows;
    std::vector<Vec3> m_before;  // impulses of the rows before the last sweep
    std::vector<Swept> m_swept;  // per row of m_before
    std::array<double, WorkingSet::kMixed> m_shares{};
    int m_slot = 0;       // slot of the newest differences
    double m_square = 0;  // approximate squared norm of the last sweep's changes [J]; 0: no sweep yet
    bool m_trusted = true;
};

}  // namespace bullet_fem
