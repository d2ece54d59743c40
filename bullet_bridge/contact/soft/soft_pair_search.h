// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>

#include "bullet_bridge/contact/soft/soft_pair_finder.h"
#include "bullet_bridge/rigid/sorted_index.h"

namespace bullet_fem
{

/// Finds the contacts of all pairs of FEM bodies that the broad phase recorded, on the given threads. Pairs that have
/// hardly moved since they were searched keep the contacts of the last step. Contacts and their order do not depend on
/// the number of threads. Memory grows, never shrinks.
class SoftPairSearch
{
public:
    /// `threads` must live as long as the search.
    explicit SoftPairSearch(const Threads& threads);
    SoftPairSearch(const SoftPairSearch&) = delete;
    SoftPairSearch& operator=(const SoftPairSearch&) = delete;

    /// Call at the start of a step: the contacts remembered so far become the warm start.
    void beginStep() { m_memory.beginStep(); }

    /// Call after solveFreeMotion, with `bodies` in an order that does not depend on addresses; `step` [s]. Keeps at
    /// most maxContacts a pair.
    void find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts);

    /// Results of find(), one origin per contact.
    const std::vector<ContactPoint>& contacts() const { return m_contacts; }
    const std::vector<SoftPairOrigin>& origins() const { return m_origins; }

    /// True if a pair whose first body is b had more contacts than find() keeps.
    bool isLimited(std::size_t b) const { return m_sides[b].m_isLimited; }

    /// Remembers the solved contacts for the next step: one for each of contacts(), in that order.
    void remember(const ContactPoint* solved);

    /// Number of pairs in which the last find() searched; the others kept the contacts of the last step.
    int searchedPairs() const;

    /// The contacts of earlier steps.
    SoftPairMemory& memory() { return m_memory; }
    const SoftPairMemory& memory() const { return m_memory; }

private:
    static constexpr int kParts = 32;  // chunks of the pairs, whatever the number of threads

    struct Pair
    {
        int m_first, m_second;  // body indices
        SoftPairIds m_ids;
        bool m_searched, m_limited, m_complete;
    };
    struct Side  // a body
    {
        double m_smallestEdge = 0;  // smallest mean edge of it and its partners [m]; 0: it has none
        bool m_isStill = false, m_isSearched = false, m_isLimited = false;  // searched or limited: some pair with it is
    };
    struct Part
    {
        explicit Part(const SoftPairMemory& memory) : m_finder(memory) {}
        SoftPairFinder m_finder;
        std::size_t m_first = 0;  // index of its first contact in those of all
        std::vector<ContactPoint> m_contacts;
        std::vector<SoftPairOrigin> m_origins;
    };

    void listPairs(const std::vector<FemSoftBody*>& bodies);
    void listOverlaps(const std::vector<FemSoftBody*>& bodies);
    void choosePairs();
    void listCarrying();
    void listNearby(const std::vector<FemSoftBody*>& bodies);
    void collectParts();
    SoftPairSide sideOf(FemSoftBody& fem, int index) const;
    void findPairs(const std::vector<FemSoftBody*>& bodies, int maxContacts, int part);

    const Threads& m_threads;
    SoftPairMemory m_memory;
    CarryingPlanes m_carrying;
    std::vector<Part> m_parts;
    SortedIndex<const btSoftBody*> m_byAddress;
    std::vector<std::pair<int, int>> m_overlapping;  // pairs of bodies, the smaller index first; ascending
    std::vector<Pair> m_pairs;
    std::vector<SoftPairIds> m_complete;                     // scratch: pairs with all of their contacts
    std::vector<int> m_paired;                               // bodies that are in some pair
    std::vector<Side> m_sides;                               // per body
    std::vector<FemSoftBody*> m_moved;                       // bodies of some pair that are not still
    std::vector<int> m_fine;                                 // searched bodies with fine surfaces
    std::vector<std::vector<SurfaceTree::Nearby>> m_nearby;  // per body; filled for those in m_fine
    std::vector<ContactPoint> m_contacts;
    std::vector<SoftPairOrigin> m_origins;
};

}  // namespace bullet_fem
