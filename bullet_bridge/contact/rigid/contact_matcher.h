// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/rigid/contact_list.h"
#include "bullet_bridge/contact/warm_start_transfer.h"

namespace bullet_fem
{

/// Warm start: matches a body's contacts with those of the last step in ContactMemory. Scratch grows with their
/// number, never shrinks.
class ContactMatcher
{
public:
    /// Notes the contact at every vertex, its own or nearby on a face or edge, that pushed most in the last step; of
    /// those that did not, the deepest.
    void begin(const FemSoftBody& fem);

    /// Per vertex, the normal of that contact, or 0.
    const std::vector<Vec3>& heldNormal() const { return m_heldNormal; }

    /// Matches the contacts to those of the last step and takes their impulses, sorted by origin as the list is. If a
    /// feature has several contacts with a leaf, the one of most similar normal and position is taken. Impulses of
    /// contacts that no longer exist are transferred to new contacts nearby.
    void transferImpulses(const SearchScope& scope, ContactList& list);

private:
    void inheritImpulses(const FemSoftBody& fem, ContactList& list);

    std::vector<Vec3> m_heldNormal;
    std::vector<const ContactPoint*> m_heldBy;  // that contact, or null
    std::vector<unsigned char> m_continued;     // per contact of the last step: its impulse was taken over
    WarmStartTransfer m_transfer;
};

}  // namespace bullet_fem
