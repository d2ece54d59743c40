// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/contact_rows.h"
#include "fem/contact/envelope_factor.h"
#include "fem/contact/rotated_anchor_factor.h"

namespace bullet_fem
{

/// All joints of a problem as one linear system, (W + yield) d = target - v - yield lambda, solved at once by a factor:
/// what heavy bodies that hang on light ones take no sweep ever hands on. What would exceed its limit is held at it,
/// and is swept like a contact until it wants less; the others are solved as if it were not there. Joints that are too
/// many for one factor are solved in parts, in turn. Those whose factor is a constant take that. Grows with the
/// problem, never shrinks.
class JointSystem
{
public:
    /// The rows must outlive it.
    explicit JointSystem(ContactRows& rows) : m_rows(rows), m_turned(rows) {}

    /// When the rows are assembled anew.
    void begin();

    /// The compliance of the rows has changed.
    void reform();

    bool isEmpty() const { return m_count == 0; }

    /// True if all joints are told what their ends' velocities lack, and change their impulses, at once: no working set
    /// need have them. `work`: whether the ends are in working sets of dense bodies.
    bool goAtOnce() const { return !isEmpty() && m_turned.hasAll(); }
    void work(bool work) { m_work = work; }

    /// Gives all joints the impulses that their ends' velocities want; the velocities follow. Returns what is left to
    /// do for another call, as the speed that a change gives a row's own point [m/s]: 0 where all are solved at once.
    double solve();

    /// For GcrIteration. Unknowns are numbered along the joints' axes, three a joint.
    int unknowns() const { return 3 * m_count; }
    ContactRow& row(int joint) { return m_rows.rows()[m_first + joint]; }

    /// What the velocities of the ends lack of what joints ask for, 0 for unknowns that are held [m/s].
    void residual(std::vector<double>& e) const;

    /// The impulses that make up for it, as far as W is right [N s].
    void answer(std::vector<double>& x);

    /// Added to what joints ask for, until the next begin() or shift [m/s]; null: nothing.
    void shift(const std::vector<double>* by);

    /// Counts how often an unknown was held or released: what was noted of the system before is of another one.
    int changes() const { return m_changes; }

private:
    struct Part  // joints that one factor has
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
    bool isBeyondLimits(const ContactRow& joint, const Vec3& impulse) const;
    double takeChanges(const Part& part);
    Vec3 changeOf(int joint) const;
    void follow();

    ContactRows& m_rows;
    int m_first = 0, m_count = 0;     // rows
    std::vector<int> m_firstOfOwner;  // per body, then per rigid proxy: first joint
    std::vector<int> m_profile;       // per joint: the first that it moves
    std::vector<Part> m_parts;        // of which the first m_partCount are used
    int m_partCount = 0;
    RotatedAnchorFactor m_turned;           // of which parts have empty rows; none where there is more than one part
    bool m_work = false;                    // working sets have the ends
    std::vector<unsigned char> m_isHeld;    // per unknown: at its limit, or nothing to solve for
    std::vector<unsigned char> m_isIdle;    // per unknown: nothing to solve for
    std::vector<double> m_shift, m_change;  // per unknown
    int m_changes = 0;
    int m_patience = 0;  // of further unknowns that may be held or released in this step
};

}  // namespace bullet_fem
