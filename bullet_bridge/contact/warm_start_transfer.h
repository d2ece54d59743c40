// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{

/// Transfers the impulses of contacts that no longer exist to nearby contacts of that pair of surfaces, as warm start.
/// Contact points of round surfaces at rest change all the time while the total force does not. Scratch grows, never
/// shrinks.
class WarmStartTransfer
{
public:
    /// Forgets all contacts. `lost`: expected number of addLost() calls.
    void clear(std::size_t lost);

    /// Adds a contact of the last step that none of this step continues: the present position of its point [m], its
    /// normal (unit), and its impulse on the surface that the normal points to [N s]. A zero impulse is ignored.
    void addLost(const Vec3& point, const Vec3& normal, const Vec3& impulse);

    /// Adds a contact of this step as a receiver; `sign` is -1 if its normal points to the other surface. The contact
    /// must live until assign().
    void addCandidate(ContactPoint& contact, double sign);

    /// Adds each lost impulse to the nearest contact of a similar normal within `reach` [m]; contacts that have no
    /// impulse and no gap come first. Without such a contact the impulse is lost. Both lists are processed in the order
    /// of addition.
    void assign(double reach);

private:
    struct Lost
    {
        Vec3 m_point, m_normal, m_impulse;
    };
    struct Candidate
    {
        ContactPoint* m_contact;
        double m_sign;
        bool m_hasImpulse;
    };

    Candidate* nearestCandidate(const Lost& lost, double reach);

    std::vector<Lost> m_lost;
    std::vector<Candidate> m_transfer;
};

}  // namespace bullet_fem
