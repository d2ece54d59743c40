// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>

#include "bullet_bridge/contact/soft/soft_pair_finder.h"

namespace bullet_fem
{

/// Finds the contacts of all pairs of FEM bodies that the broad phase recorded, on the given threads; pairs that have
/// hardly moved since they were searched keep those of the last step. The same contacts in the same order for any
/// number of threads. Grows, never shrinks.
class SoftPairSearch
{
public:
    /// `threads` must live as long as the search.
    explicit SoftPairSearch(const Threads& threads);
    SoftPairSearch(const SoftPairSearch&) = delete;
    SoftPairSearch& operator=(const SoftPairSearch&) = delete;

    /// What was remembered becomes what is taken over from: at the start of a step.
    void beginStep() { m_memory.beginStep(); }

    /// Bodies in an order that does not depend on addresses, after solveFreeMotion; `step` [s]. At most maxContacts a
    /// pair are kept.
    void find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts);

    /// What find() found: one origin a contact.
    const std::vector<ContactPoint>& contacts() const { return m_contacts; }
    const std::vector<SoftPairOrigin>& origins() const { return m_origins; }

    /// True if a pair of body b had more contacts than are kept, and b came first in it.
    bool isLimited(std::size_t b) const { return m_limited[b] != 0; }

    /// Keeps what find() found, solved: one contact for each of contacts().
    void remember(const ContactPoint* solved);

    /// Pairs in which find() searched; of the others it kept the contacts of the last step.
    int searchedPairs() const;

    /// What is known of earlier steps.
    SoftPairMemory& memory() { return m_memory; }
    const SoftPairMemory& memory() const { return m_memory; }

private:
    static constexpr int kParts = 32;  // of the pairs, whatever the number of threads

    struct Pair
    {
        int m_first, m_second;  // bodies
        SoftPairIds m_ids;
        bool m_searched, m_limited, m_complete;
    };
    struct Part
    {
        explicit Part(const SoftPairMemory& memory) : m_finder(memory) {}
        SoftPairFinder m_finder;
        std::vector<ContactPoint> m_contacts;
        std::vector<SoftPairOrigin> m_origins;
    };

    void listPairs(const std::vector<FemSoftBody*>& bodies);
    void listTouching(const std::vector<FemSoftBody*>& bodies);
    void choosePairs();
    void listNearby(const std::vector<FemSoftBody*>& bodies);
    void collectParts();
    void findPairs(const std::vector<FemSoftBody*>& bodies, int maxContacts, int part);

    const Threads& m_threads;
    SoftPairMemory m_memory;
    std::vector<Part> m_parts;
    std::vector<std::pair<const btSoftBody*, int>> m_byAddress;  // bodies, ascending
    std::vector<std::pair<int, int>> m_touching;                 // bodies, the first not after the second; ascending
    std::vector<Pair> m_pairs;
    std::vector<SoftPairIds> m_complete;  // pairs, scratch
    std::vector<int> m_paired;            // bodies that are in a pair
    std::vector<double> m_smallestEdge;   // per body: of those that it is paired with, and its own [m]; 0: with none
    std::vector<unsigned char> m_isStill, m_isSearched;      // per body; searched: in a pair that is
    std::vector<FemSoftBody*> m_moved;                       // of those in a pair, the ones that are not still
    std::vector<int> m_fine;                                 // bodies with fine surfaces that are searched
    std::vector<std::vector<SurfaceTree::Nearby>> m_nearby;  // per body; of those in m_fine
    std::vector<unsigned char> m_limited;                    // per body
    std::vector<std::size_t> m_firstOfPart;                  // and the end, in these:
    std::vector<ContactPoint> m_contacts;
    std::vector<SoftPairOrigin> m_origins;
};

}  // namespace bullet_fem
