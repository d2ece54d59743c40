// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/compliance/envelope_factor.h"
#include "fem/contact/constraints/contact_rows.h"
#include "fem/contact/solver/rotated_anchor_factor.h"

namespace bullet_fem
{

/// All joints of a problem as one linear system, (W + yield) d = target - v - yield lambda, solved at once by a factor,
/// because sweeps never pass on the load of heavy bodies that hang on light ones. A joint that would exceed its limit
/// is held at it, and is swept like a contact until it needs less; the others are solved without it. Too many joints
/// for one factor are solved in parts, in turn. Joints with a constant factor use that (RotatedAnchorFactor). Grows
/// with the problem, never shrinks.
class JointSystem
{
public:
    /// The rows must outlive it.
    explicit JointSystem(ContactRows& rows) : m_rows(rows), m_turned(rows) {}

    /// Call when the rows are assembled anew.
    void begin();

    /// Call when the compliance of the rows has changed.
    void reform();

    bool isEmpty() const { return m_count == 0; }

    /// True if solve() satisfies all joints exactly, whatever the velocities: none has a limit, and one factor of the
    /// present W serves all.
    bool isLinear() const { return m_isLinear; }

    /// True if all joints read their residuals and change their impulses at once: no working set needs their sides.
    /// `work`: whether the sides are in working sets of dense bodies.
    bool goAtOnce() const { return !isEmpty() && m_turned.hasAll(); }
    void work(bool work) { m_work = work; }

    /// Solves all joints for their sides' velocities, which follow. Returns the remaining change for another call, as
    /// the velocity of a row's own point [m/s]: 0 if all are solved at once.
    double solve();

    /// For GcrIteration: unknowns are numbered along the joints' axes, three per joint.
    int unknowns() const { return 3 * m_count; }
    ContactRow& row(int joint) { return m_rows.rows()[m_first + joint]; }

    /// Residuals of the joints, 0 for held unknowns [m/s].
    void residual(std::vector<double>& e) const;

    /// The impulses W^-1 times the residual [N s].
    void answer(std::vector<double>& x);

    /// Offset of the joints' targets until the next begin() or shift [m/s]; null: none.
    void shift(const std::vector<double>* by);

    /// Counter of holds and releases: records of the system are obsolete when it changes.
    int changes() const { return m_changes; }

private:
    struct Part  // joints with a common factor
    {
        int m_begin = 0, m_end = 0;
        EnvelopeFactor m_factor;
        bool m_stale = true;
    };

    void chooseParts();
    void addPart(int begin, int end);
    void addRows(Part& part);
    void form(Part& part);
    void dropTurned(Part& part, int joint);
    double refine(Part& part, double missed);
    int firstWithOwner(const ConstraintSide& end, int joint);
    Mat3 between(const ContactRow& a, const ContactRow& b) const;
    const ContactRow& row(int joint) const { return m_rows.rows()[m_first + joint]; }
    double residual(int joint, int axis, const Vec3& velocity) const;
    void answer(Part& part, std::vector<double>& x);
    double solvePart(Part& part);
    double missBy(const Part& part);
    double sweepHeld(Part& part, int joint);
    bool holdBeyondLimits(Part& part, double& largest);
    bool holdLimited(const Part& part);
    bool isLimited(int joint, int axis) const;
    bool isBeyondLimits(const ContactRow& joint, const Vec3& impulse) const;
    double takeChanges(const Part& part);
    Vec3 changeOf(int joint) const;
    void follow();

    ContactRows& m_rows;
    int m_first = 0, m_count = 0;     // rows
    std::vector<int> m_firstOfOwner;  // per body, then per rigid proxy: first joint
    std::vector<int> m_profile;       // per joint: the first joint coupled to it
    std::vector<Part> m_parts;        // the first m_partCount are used
    int m_partCount = 0;
    RotatedAnchorFactor m_turned;         // its joints have empty rows in the parts; unused if there are several parts
    bool m_work = false;                  // the sides are in working sets
    std::vector<unsigned char> m_isHeld;  // per unknown: at its limit, or nothing to solve for
    std::vector<unsigned char> m_isIdle;  // per unknown: nothing to solve for
    std::vector<double> m_shift, m_change;  // per unknown
    bool m_isLinear = false;
    int m_changes = 0;
    int m_patience = 0;  // remaining holds and releases in this step
};

}  // namespace bullet_fem
