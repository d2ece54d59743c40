// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/contact/carrying_planes.h"
#include "bullet_bridge/contact/contact_reduction.h"
#include "bullet_bridge/contact/soft/edge_pair_search.h"
#include "bullet_bridge/contact/soft/soft_pair_memory.h"
#include "bullet_bridge/contact/warm_start_transfer.h"

namespace bullet_fem
{

/// A body and its index in the contact problem.
struct SoftPairSide
{
    FemSoftBody& m_fem;
    int m_index;
    CarryingPlane m_carrying = {};  ///< by which it slides on others
};

/// Results of a search between soft bodies, besides the contacts.
struct SoftPairReport
{
    int m_contacts = 0;      ///< number of contacts appended
    bool m_limited = false;  ///< more contacts than permitted were found; they were thinned by place
    bool m_thinned = false;  ///< contacts of a fine skin were thinned: see ContactReduction
};

/// Search distances for two bodies; call after SoftSurface::place of both.
ContactReach reachBetween(const FemSoftBody& first, const FemSoftBody& second);

/// Finds the contacts between the surfaces of two FEM bodies, or of one with itself, present or possible within the
/// step: nodes against faces both ways (NodeSurfaceSearch) and ridges against ridges (EdgePairSearch). Gaps are those
/// as the step begins, less both contact offsets (except for self contact). A pair whose predicted gap falls below 5 %
/// of the smaller mean edge within the step is a contact. Penetrations are resolved along the shortest way out at any
/// depth up to half a body, in self contact up to half an edge. Friction is the larger kDF, restitution the product of
/// both. Scratch grows, never shrinks; one finder per thread.
class SoftPairFinder
{
public:
    /// `memory` holds the contacts whose impulses are the warm start; it must outlive the finder.
    explicit SoftPairFinder(const SoftPairMemory& memory) : m_memory(&memory) {}

    /// Call after solveFreeMotion and SoftSurface::prepareAll of both. Appends at most maxContacts contacts with warm
    /// start, ascending by origin. m_soft is the node of node contacts, and the first body's point of edge contacts.
    /// Exchanging first and second changes the order, and the roles in edge contacts, but not the points.
    SoftPairReport find(const SoftPairSide& first, const SoftPairSide& second, int maxContacts,
                        std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins);

    /// Replaces find() for bodies that have hardly moved since the search of the last step's contacts: appends those
    /// contacts with their old normals, and the present gaps of their points along them.
    SoftPairReport keep(const SoftPairSide& first, const SoftPairSide& second, int maxContacts,
                        std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins);

private:
    struct Roles  // the bodies in the roles of a contact's sides
    {
        const SoftPairSide& m_soft;
        const SoftPairSide& m_other;
        SoftPairOrigin m_origin;
    };

    void tell(SoftPairReport& report, std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins) const;
    void listHeldEdges();
    static ContactPoint commonOf(const FemSoftBody& first, const FemSoftBody& second);
    void append(const Roles& roles, double offset);
    void dropSeams(const SoftPairSide& slider, const SoftPairSide& ground, const ContactReach& reach, bool isFirst);
    void partDeep(Roles roles, const ContactReach& reach, double offset);
    static Vec3 patchOf(const Roles& roles, const SurfaceContact& touch, const ContactPoint& contact);
    int remembered(const SoftPairOrigin& origin, const Vec3& normal) const;
    bool thin(const SoftPairSide& first, const SoftPairSide& second);
    bool limit(const SoftPairSide& first, const SoftPairSide& second, int maxContacts);
    void listForReduction(const SoftPairSide& first, const SoftPairSide& second, bool byFirst, double cell);
    void transferImpulses();
    void inheritImpulses(const SoftPairSide& first, const SoftPairSide& second);

    NodeSurfaceSearch m_nodesOfFirst, m_nodesOfSecond;
    EdgePairSearch m_edges;
    std::vector<SurfaceContact> m_touches;
    std::vector<ContactPoint> m_found;
    std::vector<SoftPairOrigin> m_foundOrigins;
    std::vector<int> m_order;
    const SoftPairMemory* m_memory;
    SoftPairMemory::Last m_last;             // contacts of the pair in the last step
    std::vector<EdgePair> m_heldEdges;       // edge pairs of these that pushed
    std::vector<unsigned char> m_continued;  // per contact of these: its impulse was taken over
    WarmStartTransfer m_transfer;
    ContactReduction m_reduction;
};

}  // namespace bullet_fem
