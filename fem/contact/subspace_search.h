// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/contact_rows.h"

namespace bullet_fem
{

/// Gauss-Seidel finds quickly what touches and what slides, and slowly how forces spread over many points of one body.
/// Over the points that neither part nor slide the problem is linear, and conjugate gradients minimize from time to
/// time [Silcowitz, Niebe, Erleben 2010, projected Gauss-Seidel subspace minimization]. If sweeps find more to do after
/// it than before, it led astray and is taken back. A sweep comes last, and leaves all impulses in their cones.
class SubspaceSearch
{
public:
    /// The rows must outlive it.
    explicit SubspaceSearch(ContactRows& rows) : m_rows(rows) {}

    /// When the rows are assembled anew.
    void begin();

    /// Forgets all sweeps.
    void reset();

    /// The work of sweeps so far is that of another problem: more of it is no sign that the last search led astray.
    void expectMore() { m_tried = false; }

    /// After every sweep: what it has changed, roughly [J].
    void noteSweep(double work);

    /// True if as many sweeps have been made as are to be between two searches: they find out what touches, slides and
    /// sticks.
    bool isDue() const;

    /// Searches over these rows, or takes the last search back.
    void search(const std::vector<int>& working);

private:
    struct Direction  // of one row
    {
        int m_row;
        int m_freeAxes;                            // that nothing limits: 1: the normal; 3: all
        Vec3 m_impulse;                            // before
        Vec3 m_residual, m_direction, m_response;  // along the axes
    };

    void choose(const std::vector<int>& working);
    void minimize();
    template <class Term>
    double sum(const Term& term);
    void respondToDirections();
    void followDirections(double step);

    ContactRows& m_rows;
    std::vector<Direction> m_directions;
    std::vector<Vec3> m_linear, m_angular;  // of the obstacles, by all directions
    int m_sweeps = 0;                       // since the last search
    double m_sweepWork = 0;                 // of the last sweep's changes
    double m_work = 0;                      // the same before the last search
    bool m_tried = false;                   // its sweeps have not proved it yet
};

}  // namespace bullet_fem
