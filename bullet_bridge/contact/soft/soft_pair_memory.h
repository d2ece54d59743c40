// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <tuple>
#include <vector>

#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{

/// Which features of two soft bodies make a contact.
enum class SoftPairKind
{
    nodeOfFirst,   ///< with a face of the second body
    nodeOfSecond,  ///< with a face of the first body
    edges
};

/// Where a contact point between soft bodies came from: how it is recognised in the next step.
struct SoftPairOrigin
{
    int m_firstId = 0;   ///< broadphase id of the body that was given first
    int m_secondId = 0;  ///< and of the other; the same for self contact
    SoftPairKind m_kind = SoftPairKind::nodeOfFirst;
    int m_feature = 0;       ///< the node, or the edge of the first body
    int m_otherFeature = 0;  ///< the triangle, -1 for a nearest edge or corner, or the edge of the second body

    bool operator<(const SoftPairOrigin& b) const
    {
        return std::tie(m_firstId, m_secondId, m_kind, m_feature, m_otherFeature) <
               std::tie(b.m_firstId, b.m_secondId, b.m_kind, b.m_feature, b.m_otherFeature);
    }
    bool isOfPair(int firstId, int secondId) const { return m_firstId == firstId && m_secondId == secondId; }
};

/// Two bodies by their broadphase ids, the first as in SoftPairOrigin.
struct SoftPairIds
{
    int m_firstId = 0, m_secondId = 0;

    bool operator<(const SoftPairIds& b) const
    {
        return std::tie(m_firstId, m_secondId) < std::tie(b.m_firstId, b.m_secondId);
    }
};

/// The contacts between soft bodies of the last step, for those of this one to continue; and those of this one, for the
/// next. Grows, never shrinks. May be read by several threads at once.
class SoftPairMemory
{
public:
    /// Contacts, and where they come from.
    struct Contacts
    {
        const ContactPoint* m_contacts = nullptr;
        const SoftPairOrigin* m_origins = nullptr;
        std::size_t m_count = 0;
    };
    using Last = Contacts;  ///< some of the last step, the origins ascending

    /// What was remembered becomes the last step: at the start of a step.
    void beginStep();

    /// Keeps solved contacts for the next step: one origin a contact, each once; and the pairs of which these are all.
    void remember(const Contacts& contacts, const std::vector<SoftPairIds>& completePairs = {});

    /// What was remembered since the step began: what the next one depends on.
    struct Kept
    {
        std::vector<ContactPoint> m_contacts;
        std::vector<SoftPairOrigin> m_origins;  ///< one a contact
        std::vector<SoftPairIds> m_completePairs;
    };
    Kept kept() const { return {m_next, m_nextOrigins, m_nextComplete}; }

    /// Remembers this and nothing else.
    void restore(const Kept& kept);

    /// All contacts of the last step, or those of a pair of broadphase ids.
    Last last() const { return {m_last.data(), m_lastOrigins.data(), m_last.size()}; }
    Last lastOf(int firstId, int secondId) const;
    /// True if these are all contacts that the pair had in the last step, be they none.
    bool isComplete(const SoftPairIds& pair) const;

private:
    void takeOverContacts();

    std::vector<ContactPoint> m_last, m_next;
    std::vector<SoftPairOrigin> m_lastOrigins, m_nextOrigins;
    std::vector<SoftPairIds> m_lastComplete, m_nextComplete;  // the last ascending
    std::vector<int> m_order;
};

}  // namespace bullet_fem
