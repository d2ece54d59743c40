// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/solver/contact_sweeps.h"

namespace bullet_fem
{

/// Position correction: solves the rows again for velocities that remove penetration. Grows with the problem, never
/// shrinks.
class PositionCorrection
{
public:
    /// Rows and sweeps must outlive it.
    PositionCorrection(ContactRows& rows, ContactSweeps& sweeps) : m_rows(rows), m_sweeps(sweeps) {}

    /// Call when the rows are assembled anew.
    void begin();

    /// True if a penetration exceeds its slop by more than the tolerance of the sweeps.
    bool isNeeded() const;

    /// Call after the impulses are stored, which it overwrites. Returns the number of sweeps.
    int push();

private:
    struct Pushed  // effect of position corrections on a body
    {
        Vec3 m_gained;                     // gained angular momentum [kg m2/s]
        double m_total = 0, m_bySoft = 0;  // sum of impulses on it, and of those by soft bodies [N s]
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
    std::vector<RigidProxy> m_own;  // the problem's proxies, with their velocities and impulses saved
    std::vector<Pushed> m_pushed;   // one per body
    std::vector<Vec3> m_base;       // one per row: share of its impulse that has not moved the nodes yet [N s]
    double m_step = 0;              // [s]
};

}  // namespace bullet_fem
