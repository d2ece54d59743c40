// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// True if the surfaces pushed each other there.
inline bool isPushing(const ContactPoint& contact)
{
    return dot(contact.m_impulse, contact.m_normal) > 0;
}

/// Thins the contacts of a surface that is much finer than the tetrahedra that it follows: these deform linearly, and a
/// few points of each say what hundreds would, which make the solution slow and no better. Of contacts with one object
/// in one cell of the rest shape, half an edge of the tetrahedra wide, those are kept that held something in the last
/// step (they are a set of active constraints), and the one that comes deepest by the end of this step, if it is deeper
/// than these by the slop, or if their normals differ. Scratch grows, never shrinks.
class ContactReduction
{
public:
    /// Width of the cells for a body [m]; 0 if its contacts need no thinning.
    static double cellOf(const FemSoftBody& fem);

    /// Forgets all.
    void clear(double cell);

    /// A contact, where it is in the rest shape [m], its gap as the step ends [m], and whether it pushed in the last.
    struct Given
    {
        int m_objectId;
        const ContactPoint& m_contact;
        Vec3 m_restPoint;
        double m_gapThen;
        bool m_held;
    };
    void add(const Given& given);

    /// Drops contacts, one for each that was added, and what belongs to them.
    template <class Origin>
    void thin(std::vector<ContactPoint>& contacts, std::vector<Origin>& origins)
    {
        choose();
        std::size_t kept = 0;
        for (std::size_t k = 0; k < contacts.size(); ++k)
        {
            if (!m_kept[k]) continue;
            contacts[kept] = contacts[k];
            origins[kept++] = origins[k];
        }
        contacts.resize(kept);
        origins.resize(kept);
    }

private:
    struct Candidate
    {
        int m_objectId;
        std::array<int, 3> m_cell;
        bool m_isNew;  // did not hold anything
        double m_gap, m_slop;
        int m_index;
        Vec3 m_normal;

        bool isInCellOf(const Candidate& b) const { return m_objectId == b.m_objectId && m_cell == b.m_cell; }
    };

    void choose();
    bool isNeeded(std::size_t candidate, std::size_t firstOfCell) const;

    double m_cell = 1;
    std::vector<Candidate> m_candidates;
    std::vector<unsigned char> m_kept;
};

}  // namespace bullet_fem
