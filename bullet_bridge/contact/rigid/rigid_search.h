// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <utility>

#include "bullet_bridge/contact/rigid/contact_finder.h"
#include "bullet_bridge/rigid/sorted_index.h"

class btBroadphaseInterface;

namespace bullet_fem
{

class Threads;

/// Finds the contacts of FEM bodies with the rigid objects that the broad phase recorded, on the given threads.
/// Contacts and their order do not depend on the number of threads. Memory grows, never shrinks.
class RigidSearch
{
public:
    /// `threads` must live as long as the search. `searchesAhead`: contacts of rolling rigid bodies are searched where
    /// these will be, for impulses that act at the end of the step, as with implicit Euler.
    explicit RigidSearch(const Threads& threads, bool searchesAhead = true);
    RigidSearch(const RigidSearch&) = delete;
    RigidSearch& operator=(const RigidSearch&) = delete;

    /// Call at the start of a step: shapes may have been deleted since the one before the last.
    void beginStep();

    /// Call after solveFreeMotion, with `bodies` in an order that does not depend on addresses. Replaces m_contacts and
    /// m_origins of each body by those of this step, with m_soft.m_body = its index. Keeps at most maxContacts a body;
    /// `step` [s].
    void find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts, RigidProxies& rigidProxies);

    /// Flags of the last find(), one entry per body.
    const std::vector<ContactSearchReport>& reports() const { return m_reports; }

private:
    static constexpr int kParts = 32;  // chunks of the bodies, whatever the number of threads

    /// The objects near a body, listed on one thread: rigid proxies are made at their first use.
    struct Overlap
    {
        int m_first, m_count;  // range of m_touched
        bool m_alone;          // a shape must be queried on one thread only
    };
    struct ShapeRange
    {
        int m_first = -1, m_count = 0;  // range of m_leaves
        bool m_unknown = false, m_alone = false;
        Vec3 m_advance;  // see ContactObject
    };

    void listCarrying(const std::vector<FemSoftBody*>& bodies);
    void listOverlapping(const std::vector<FemSoftBody*>& bodies);
    void removeGone(FemSoftBody& fem, int body) const;
    void listContacts(FemSoftBody& fem, double step, RigidProxies& rigidProxies);
    const ShapeRange& shapeOf(const btCollisionObject& object, int rigidProxy, double step,
                              const RigidProxies& rigidProxies);

    bool mayBeStopped(const btCollisionObject& object, int rigidProxy, const RigidProxies& rigidProxies) const;
    CarryingPlane carryingPlaneOf(const btCollisionObject& object, const RigidProxy& rigidProxy, double step) const;
    Vec3 advanceOf(const btCollisionObject& object, const ShapeLeaf& leaf, const RigidProxy& proxy, double step) const;
    bool givesTriangles(const ShapeLeaf& leaf);

    const Threads& m_threads;
    const bool m_searchesAhead;
    std::vector<ContactFinder> m_finders;
    std::vector<Overlap> m_overlapping;    // one per body
    std::vector<ContactObject> m_touched;  // body by body
    std::vector<ShapeRange> m_shapes;      // one per rigid proxy
    btAlignedObjectArray<ShapeLeaf> m_leaves;
    SortedIndex<const btCollisionShape*> m_giving, m_gaveLast;  // a program's own shapes that reported triangles in
                                                                // this step and in the last
    CarryingPlanes m_carrying;                                  // of the objects, by those of the last step
    std::vector<ContactSearchReport> m_reports;
    SortedIndex<const void*> m_byAddress;                         // bodies
    std::vector<const btBroadphaseInterface*> m_broadphases;      // the bodies' broad phases, each once
    std::vector<std::pair<int, const void*>> m_overlappingPairs;  // bodies and the objects that they overlap, ascending
    std::vector<const void*> m_inPairs;  // objects other than the bodies, once for each pair of theirs, ascending
};

}  // namespace bullet_fem
