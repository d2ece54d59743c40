// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/contact_sweeps.h"

namespace bullet_fem
{

/// Takes penetration back: the same rows once more, for the velocities of position correction. Grows with the problem,
/// never shrinks.
class PositionCorrection
{
public:
    /// Rows and sweeps must outlive it.
    PositionCorrection(ContactRows& rows, ContactSweeps& sweeps) : m_rows(rows), m_sweeps(sweeps) {}

    /// When the rows are assembled anew.
    void begin();

    /// True if a penetration exceeds its slop, by more than sweeps would leave of it.
    bool isNeeded() const;

    /// When the impulses are stored, which it forgets. Returns the sweeps made.
    int push();

private:
    struct Pushed  // a body, by its position corrections
    {
        Vec3 m_gained;                     // angular momentum [kg m2/s]
        double m_total = 0, m_bySoft = 0;  // impulses on it, and those of soft bodies [N s]
    };

    bool lags() const;
    Vec3 lagOf(const ContactRow& row, const Joint& joint) const;
    Vec3 pushOf(std::size_t row) const { return m_rows.rows()[row].m_impulse - m_base[row]; }
    void prepare();
    void prepareContact(const ContactPoint& contact, ContactRow& row) const;
    void prepareJoints();
    void prepareContacts();
    void sumImpulses();
    void payBack();

    ContactRows& m_rows;
    ContactSweeps& m_sweeps;
    std::vector<RigidProxy> m_own;  // the problem's, with their own velocities and what they felt for these
    std::vector<Pushed> m_pushed;   // one a body
    std::vector<Vec3> m_base;       // one a row: the share of its impulse that has not moved the nodes yet [N s]
    double m_step = 0;              // [s]
};

}  // namespace bullet_fem
