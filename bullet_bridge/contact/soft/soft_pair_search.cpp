// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/soft_pair_search.h"

#include <algorithm>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/geometry/tolerances.h"
#include "bullet_bridge/joints/welds.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{
namespace
{

// Largest displacement of a still body's nodes since they were noted, in mean edges. Two still bodies approach each
// other by up to four times as much since they were searched: half the contact band.
constexpr double kStillShare = 0.00625;
constexpr int kFineTriangles = 2000;  // triangles from which on prepareNear() pays off: those of some thousand elements

bool isFine(const SoftSurface& surface)
{
    return surface.topology().triangleCount() >= kFineTriangles;
}

}  // namespace

SoftPairSearch::SoftPairSearch(const Threads& threads)
    : m_threads(threads), m_carrying(kSameNormalCosine), m_parts(kParts, Part(m_memory))
{
}

void SoftPairSearch::find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts)
{
    listPairs(bodies);
    const int paired = static_cast<int>(m_paired.size());
    m_threads.run(paired,
                  [&](int k)
                  {
                      const int b = m_paired[k];
                      FemSoftBody& fem = *bodies[b];
                      fem.updateSkin();
                      m_sides[b].m_isStill = fem.m_memory.m_place.isStill(
                          fem.surfacePosition(), fem.surfaceVelocity(), step, kStillShare * m_sides[b].m_smallestEdge);
                  });
    choosePairs();
    m_threads.run(paired,
                  [&](int k)
                  {
                      const int b = m_paired[k];
                      FemSoftBody& fem = *bodies[b];
                      if (!m_sides[b].m_isSearched) return;
                      fem.m_surface.place(fem.surfacePosition(), fem.surfaceVelocity(), step);
                      if (!isFine(fem.m_surface)) fem.m_surface.prepareAll();
                      fem.m_search.m_meanMotion = meanMotion(fem.m_body);
                  });
    listCarrying();
    listNearby(bodies);
    m_threads.run(static_cast<int>(m_fine.size()),
                  [&](int k) { bodies[m_fine[k]]->m_surface.prepareNear(m_nearby[m_fine[k]]); });
    m_moved.clear();
    for (int b : m_paired)
        if (!m_sides[b].m_isStill) m_moved.push_back(bodies[b]);
    m_threads.run(kParts, [&](int part) { findPairs(bodies, maxContacts, part); });
    collectParts();
    for (const Pair& pair : m_pairs)
        if (pair.m_limited) m_sides[pair.m_first].m_isLimited = true;
}

void SoftPairSearch::collectParts()
{
    std::size_t count = 0;
    for (Part& part : m_parts)
    {
        part.m_first = count;
        count += part.m_contacts.size();
    }
    m_contacts.resize(count);
    m_origins.resize(count);
    m_threads.run(kParts,
                  [this](int k)
                  {
                      const Part& part = m_parts[k];
                      const auto first = static_cast<std::ptrdiff_t>(part.m_first);
                      std::copy(part.m_contacts.begin(), part.m_contacts.end(), m_contacts.begin() + first);
                      std::copy(part.m_origins.begin(), part.m_origins.end(), m_origins.begin() + first);
                  });
}

// Finds the faces by which bodies lay on each other in the last step: each lies on the other.
void SoftPairSearch::listCarrying()
{
    m_carrying.clear();
    const SoftPairMemory::Last last = m_memory.last();
    for (std::size_t k = 0; k < last.m_count; ++k)
    {
        const ContactPoint& contact = last.m_contacts[k];
        const SoftPairOrigin& origin = last.m_origins[k];
        const double size = dot(contact.m_impulse, contact.m_normal);
        if (!(size > 0) || origin.m_firstId == origin.m_secondId) continue;
        const bool ofSecond = origin.m_kind == SoftPairKind::nodeOfSecond;
        m_carrying.add({ofSecond ? origin.m_secondId : origin.m_firstId, size, -contact.m_normal, contact.m_point});
        m_carrying.add({ofSecond ? origin.m_firstId : origin.m_secondId, size, contact.m_normal, contact.m_point});
    }
    m_carrying.find();
}

// A pair is searched unless both bodies are still and its remembered contacts are complete. Only surfaces of searched
// pairs are updated.
void SoftPairSearch::choosePairs()
{
    for (Pair& pair : m_pairs)
    {
        Side &first = m_sides[pair.m_first], &second = m_sides[pair.m_second];
        pair.m_searched = !(first.m_isStill && second.m_isStill && m_memory.isComplete(pair.m_ids));
        if (pair.m_searched) first.m_isSearched = second.m_isSearched = true;
    }
}

// Lists the bounds of the bodies near each fine surface; with self contact, its own.
void SoftPairSearch::listNearby(const std::vector<FemSoftBody*>& bodies)
{
    if (m_nearby.size() < bodies.size()) m_nearby.resize(bodies.size());
    m_fine.clear();
    for (int b : m_paired)
        if (m_sides[b].m_isSearched && isFine(bodies[b]->m_surface)) m_fine.push_back(b);
    if (m_fine.empty()) return;
    for (int b : m_fine) m_nearby[b].clear();
    for (const Pair& pair : m_pairs)
    {
        if (!pair.m_searched) continue;
        const FemSoftBody &first = *bodies[pair.m_first], &second = *bodies[pair.m_second];
        const double reach = reachBetween(first, second).near();
        m_nearby[pair.m_first].push_back({second.m_surface.tree().coarseBounds(), reach});
        m_nearby[pair.m_second].push_back({first.m_surface.tree().coarseBounds(), reach});
    }
}

// The first body of a pair is the one of smaller broadphase id.
void SoftPairSearch::listPairs(const std::vector<FemSoftBody*>& bodies)
{
    m_sides.assign(bodies.size(), {});
    const auto pairWith = [&](int b, double edge)
    {
        double& smallest = m_sides[b].m_smallestEdge;
        smallest = smallest > 0 ? std::min(smallest, edge) : edge;
    };
    listOverlaps(bodies);
    m_pairs.clear();
    for (const auto& [a, b] : m_overlapping)
    {
        const double edge = std::min(bodies[a]->m_surface.meanEdge(), bodies[b]->m_surface.meanEdge());
        pairWith(a, edge);
        pairWith(b, edge);
        const int idA = broadphaseId(*bodies[a]->m_softBody), idB = broadphaseId(*bodies[b]->m_softBody);
        if (idA <= idB)
            m_pairs.push_back({a, b, {idA, idB}, false, false, false});
        else
            m_pairs.push_back({b, a, {idB, idA}, false, false, false});
    }
    m_paired.clear();
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (m_sides[b].m_smallestEdge > 0) m_paired.push_back(static_cast<int>(b));
}

// A pair may be recorded by either body, or by both.
void SoftPairSearch::listOverlaps(const std::vector<FemSoftBody*>& bodies)
{
    m_byAddress.clear();
    for (std::size_t b = 0; b < bodies.size(); ++b) m_byAddress.add(bodies[b]->m_softBody, b);
    m_overlapping.clear();
    for (int a = 0; a < static_cast<int>(bodies.size()); ++a)
        for (const btSoftBody* other : bodies[a]->m_overlaps.m_soft)
        {
            const int b = m_byAddress.find(other);
            if (b >= 0 && mayTouch(*bodies[a], *bodies[b])) m_overlapping.emplace_back(std::min(a, b), std::max(a, b));
        }
    std::sort(m_overlapping.begin(), m_overlapping.end());
    m_overlapping.erase(std::unique(m_overlapping.begin(), m_overlapping.end()), m_overlapping.end());
}

SoftPairSide SoftPairSearch::sideOf(FemSoftBody& fem, int index) const
{
    const RigidMotion motion = {{}, fem.m_search.m_meanMotion.m_velocity, {}};
    return {fem, index, m_carrying.planeOf(broadphaseId(*fem.m_softBody), motion, fem.m_surface.step())};
}

void SoftPairSearch::findPairs(const std::vector<FemSoftBody*>& bodies, int maxContacts, int part)
{
    Part& p = m_parts[part];
    p.m_contacts.clear();
    p.m_origins.clear();
    const std::size_t begin = m_pairs.size() * part / kParts, end = m_pairs.size() * (part + 1) / kParts;
    for (std::size_t k = begin; k < end; ++k)
    {
        Pair& pair = m_pairs[k];
        const SoftPairSide first = sideOf(*bodies[pair.m_first], pair.m_first);
        const SoftPairSide second = sideOf(*bodies[pair.m_second], pair.m_second);
        const SoftPairReport found = pair.m_searched
                                         ? p.m_finder.find(first, second, maxContacts, p.m_contacts, p.m_origins)
                                         : p.m_finder.keep(first, second, maxContacts, p.m_contacts, p.m_origins);
        pair.m_limited = found.m_limited;
        pair.m_complete = !found.m_limited && !found.m_thinned;
    }
}

// Positions are noted together with the contacts found there: a step may search twice and use the second search only.
void SoftPairSearch::remember(const ContactPoint* solved)
{
    m_complete.clear();
    for (const Pair& pair : m_pairs)
        if (pair.m_complete) m_complete.push_back(pair.m_ids);
    m_memory.remember({solved, m_origins.data(), m_origins.size()}, m_complete);
    for (FemSoftBody* fem : m_moved) fem->m_memory.m_place.note(fem->m_surface.position());
}

int SoftPairSearch::searchedPairs() const
{
    return static_cast<int>(
        std::count_if(m_pairs.begin(), m_pairs.end(), [](const Pair& pair) { return pair.m_searched; }));
}

}  // namespace bullet_fem
