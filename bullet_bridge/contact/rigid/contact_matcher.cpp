// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/contact_matcher.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr double kMinLikeness = -2;  // smallest similarity of a contact to one of the last step; 1: equal
constexpr double kOfVertex = 0.9;    // weight of a vertex from which on a contact is at it [-]

// True if a contact pushes more than another, or as much and is deeper: of a vertex that only touches, edges beside it
// may bear the load. `other` may be null.
bool holdsMore(const ContactPoint& contact, const ContactPoint* other)
{
    if (other == nullptr) return true;
    const double push = dot(contact.m_impulse, contact.m_normal), otherPush = dot(other->m_impulse, other->m_normal);
    return push > otherPush || (push == otherPush && contact.m_gap < other->m_gap);
}

// The vertex that has most of a contact, or -1. Corners of faces and edges are nodes, unless the surface is a drawn
// one.
int vertexOf(const FemSoftBody& fem, int feature, const ContactPoint& contact)
{
    if (feature < fem.m_surface.topology().vertexCount()) return feature;
    for (int a = 0; a < contact.m_soft.m_count && !fem.m_skin; ++a)
        if (contact.m_soft.m_weights[a] > kOfVertex) return contact.m_soft.m_nodes[a];
    return -1;
}

}  // namespace

void ContactMatcher::begin(const FemSoftBody& fem)
{
    const int vertexCount = fem.m_surface.topology().vertexCount();
    const ContactMemory& memory = fem.m_memory;
    m_heldNormal.assign(vertexCount, Vec3());
    m_heldBy.assign(vertexCount, nullptr);
    for (std::size_t k = 0; k < memory.m_contacts.size(); ++k)
    {
        const ContactPoint& contact = memory.m_contacts[k];
        const int vertex = vertexOf(fem, memory.m_origins[k].m_feature, contact);
        if (vertex < 0 || !holdsMore(contact, m_heldBy[vertex])) continue;
        m_heldBy[vertex] = &contact;
        m_heldNormal[vertex] = contact.m_normal;
    }
}

void ContactMatcher::transferImpulses(const SearchScope& scope, ContactList& list)
{
    const ContactMemory& memory = scope.fem().m_memory;
    const std::vector<ContactOrigin>& origins = list.origins();
    std::vector<ContactPoint>& contacts = list.points();
    m_continued.assign(memory.m_origins.size(), 0);
    for (std::size_t k = 0; k < origins.size(); ++k)
    {
        const auto range = std::equal_range(memory.m_origins.begin(), memory.m_origins.end(), origins[k]);
        double best = kMinLikeness;
        std::size_t before = memory.m_origins.size();
        for (auto old = range.first; old != range.second; ++old)
        {
            const std::size_t candidate = old - memory.m_origins.begin();
            const ContactPoint& contact = memory.m_contacts[candidate];
            const double likeness = dot(contact.m_normal, contacts[k].m_normal) -
                                    norm(contact.m_point - contacts[k].m_point) / scope.m_size;
            if (likeness <= best || m_continued[candidate]) continue;
            best = likeness;
            before = candidate;
        }
        if (before == memory.m_origins.size()) continue;
        m_continued[before] = 1;
        contacts[k].m_impulse = memory.m_contacts[before].m_impulse;
        contacts[k].m_slip = memory.m_contacts[before].m_slip;
    }
    inheritImpulses(scope.fem(), list);
}

// Transfers the impulses of contacts that no longer exist to new contacts nearby, object by object.
void ContactMatcher::inheritImpulses(const FemSoftBody& fem, ContactList& list)
{
    const std::vector<ContactOrigin>& origins = list.origins();
    const ContactMemory& memory = fem.m_memory;
    const auto idOf = [](const ContactOrigin& origin) { return origin.m_objectId; };
    for (std::size_t first = 0, end = 0, k = 0; first < memory.m_origins.size(); first = end)
    {
        const int id = idOf(memory.m_origins[first]);
        m_transfer.clear(memory.m_origins.size());
        for (end = first; end < memory.m_origins.size() && idOf(memory.m_origins[end]) == id; ++end)
        {
            const ContactPoint& old = memory.m_contacts[end];
            if (m_continued[end]) continue;
            m_transfer.addLost(old.m_soft.of(fem.m_body.m_state.m_x), old.m_normal, old.m_impulse);
        }
        while (k < origins.size() && idOf(origins[k]) < id) ++k;
        for (; k < origins.size() && idOf(origins[k]) == id; ++k) m_transfer.addCandidate(list.points()[k], 1);
        m_transfer.assign(fem.m_body.m_model->mesh().meanEdgeLength());
    }
}

}  // namespace bullet_fem
