// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// True if the contact's normal impulse is positive.
inline bool isPushing(const ContactPoint& contact)
{
    return dot(contact.m_impulse, contact.m_normal) > 0;
}

/// Thins the contacts of a surface that is much finer than its tetrahedra: a tetrahedron deforms linearly, so a few
/// points of it represent hundreds, which would only slow down the solver. A cell is half a mean tetrahedron edge wide
/// in the rest shape. A cell's contacts with one object are reduced to those that pushed in the last step (an active
/// set), and the deepest one at the end of this step if it is deeper than those by the slop or differs in its normal.
/// limit() keeps one of each direction in a cell, for any surface with too many contacts. Scratch grows, never shrinks.
class ContactReduction
{
public:
    /// Width of the cells for a body [m]; 0 if its contacts are not thinned.
    static double cellOf(const FemSoftBody& fem);

    /// Width of the smallest cells of limit() for a body [m].
    static double smallestCellOf(const FemSoftBody& fem);

    /// Forgets all contacts. `cell`: width of a cell [m], > 0.
    void clear(double cell);

    /// A contact, its point in the rest shape [m], its gap as the step ends [m], and whether it pushed in the last
    /// step.
    struct Given
    {
        int m_objectId;
        const ContactPoint& m_contact;
        Vec3 m_restPoint;
        double m_gapThen;
        bool m_held;
    };
    void add(const Given& given);

    /// Removes the contacts that are not kept, and their origins. Both arrays have one entry for each add(), in its
    /// order.
    template <class Origin>
    void thin(std::vector<ContactPoint>& contacts, std::vector<Origin>& origins)
    {
        choose(kMaxAlike);
        keepChosen(contacts, origins);
    }

    /// As thin(), but keeps about `most` (> 0) contacts, where there are more: objects with at most their share of them
    /// keep all, the others one of each direction in a cell, one that pushed in the last step if there is. Cells become
    /// wider until that suffices, or one encloses the body. False if there are no more than `most`.
    template <class Origin>
    bool limit(int most, std::vector<ContactPoint>& contacts, std::vector<Origin>& origins)
    {
        if (static_cast<int>(contacts.size()) <= most) return false;
        chooseAbout(most);
        keepChosen(contacts, origins);
        return true;
    }

private:
    static constexpr int kMaxAlike = 8;  // contacts kept in a cell that pushed in the last step and have similar
                                         // normals

    struct Candidate
    {
        int m_objectId;
        Vec3 m_restPoint;
        std::array<int, 3> m_cell;
        bool m_isNew;  // did not push in the last step
        double m_gap, m_slop;
        int m_index;
        Vec3 m_normal;

        bool isInCellOf(const Candidate& b) const { return m_objectId == b.m_objectId && m_cell == b.m_cell; }
    };

    template <class Origin>
    void keepChosen(std::vector<ContactPoint>& contacts, std::vector<Origin>& origins) const
    {
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

    void choose(int maxAlike);
    void chooseAbout(int most);
    void keepFewOf(int share);
    bool isNeeded(std::size_t candidate, std::size_t firstOfCell, int maxAlike) const;

    double m_cell = 1;
    std::vector<Candidate> m_candidates;
    std::vector<unsigned char> m_kept;
};

}  // namespace bullet_fem
