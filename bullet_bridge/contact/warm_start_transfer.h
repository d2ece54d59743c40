// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{

/// Hands the impulses of contacts that are gone to contacts near them between the same two surfaces, as guesses: where
/// round surfaces rest on each other, the points that touch change all the time, and the force between the two does
/// not. Scratch grows, never shrinks.
class WarmStartTransfer
{
public:
    /// Forgets all; `lost` are expected at most.
    void clear(std::size_t lost);

    /// A contact of the last step that none of this step continues: where its point is now [m], the normal, and the
    /// impulse on the surface that the normal points to [N s]. One without an impulse has nothing to leave.
    void addLost(const Vec3& point, const Vec3& normal, const Vec3& impulse);

    /// A contact of this step; sign -1 if its normal points to the other of the two surfaces. It must live until
    /// settle.
    void addHeir(ContactPoint& contact, double sign);

    /// Gives every lost impulse to the nearest heir of a similar normal within reach [m], first to those that have
    /// inherited none and have no gap to close; without one it is lost. In the order in which both were added.
    void settle(double reach);

private:
    struct Lost
    {
        Vec3 m_point, m_normal, m_impulse;
    };
    struct Heir
    {
        ContactPoint* m_contact;
        double m_sign;
        bool m_hasImpulse;
    };

    Heir* nearestHeir(const Lost& lost, double reach);

    std::vector<Lost> m_lost;
    std::vector<Heir> m_transfer;
};

}  // namespace bullet_fem
