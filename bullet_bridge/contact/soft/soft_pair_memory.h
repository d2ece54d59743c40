// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <tuple>
#include <vector>

#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{

/// The features of two soft bodies that make a contact.
enum class SoftPairKind
{
    nodeOfFirst,   ///< with a face of the second body
    nodeOfSecond,  ///< with a face of the first body
    edges
};

/// Identifies a contact point between soft bodies from step to step.
struct SoftPairOrigin
{
    int m_firstId = 0;   ///< broadphase id of the first body
    int m_secondId = 0;  ///< broadphase id of the second body, equal to m_firstId in self contact
    SoftPairKind m_kind = SoftPairKind::nodeOfFirst;
    int m_feature = 0;       ///< the node, or the edge of the first body
    int m_otherFeature = 0;  ///< the triangle (-1: a nearest edge or corner), or the edge of the second body

    bool operator<(const SoftPairOrigin& b) const
    {
        return std::tie(m_firstId, m_secondId, m_kind, m_feature, m_otherFeature) <
               std::tie(b.m_firstId, b.m_secondId, b.m_kind, b.m_feature, b.m_otherFeature);
    }
    bool isOfPair(int firstId, int secondId) const { return m_firstId == firstId && m_secondId == secondId; }
};

/// Two bodies by their broadphase ids, in the order of SoftPairOrigin.
struct SoftPairIds
{
    int m_firstId = 0, m_secondId = 0;

    bool operator<(const SoftPairIds& b) const
    {
        return std::tie(m_firstId, m_secondId) < std::tie(b.m_firstId, b.m_secondId);
    }
};

/// The contacts between soft bodies of the last step, as the warm start of this one, and those of this step for the
/// next. Grows, never shrinks. May be read by several threads at once.
class SoftPairMemory
{
public:
    /// An array of contacts and one of their origins, both of m_count entries.
    struct Contacts
    {
        const ContactPoint* m_contacts = nullptr;
        const SoftPairOrigin* m_origins = nullptr;
        std::size_t m_count = 0;
    };
    using Last = Contacts;  ///< contacts of the last step, ascending by origin

    /// Call at the start of a step: the contacts remembered so far become those of the last step.
    void beginStep();

    /// Keeps solved contacts for the next step, with one origin per contact, without duplicates. `completePairs`: pairs
    /// all of whose contacts are among these.
    void remember(const Contacts& contacts, const std::vector<SoftPairIds>& completePairs = {});

    /// A copy of the contacts remembered since the step began: the state on which the next step depends.
    struct Kept
    {
        std::vector<ContactPoint> m_contacts;
        std::vector<SoftPairOrigin> m_origins;  ///< one per contact
        std::vector<SoftPairIds> m_completePairs;
    };

    /// The contacts remembered since the step began.
    Kept kept() const { return {m_next, m_nextOrigins, m_nextComplete}; }

    /// Replaces all remembered contacts by these.
    void restore(const Kept& kept);

    /// All contacts of the last step, or those of one pair of broadphase ids.
    Last last() const { return {m_last.data(), m_lastOrigins.data(), m_last.size()}; }
    Last lastOf(int firstId, int secondId) const;
    /// True if the contacts of the last step include all contacts of the pair, of which there may be none.
    bool isComplete(const SoftPairIds& pair) const;

private:
    void takeOverContacts();

    std::vector<ContactPoint> m_last, m_next;
    std::vector<SoftPairOrigin> m_lastOrigins, m_nextOrigins;
    std::vector<SoftPairIds> m_lastComplete, m_nextComplete;  // m_lastComplete is sorted
    std::vector<int> m_order;
};

}  // namespace bullet_fem
