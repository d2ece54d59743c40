// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/body/fem_soft_body.h"
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
};

/// What a search between soft bodies found besides contacts.
struct SoftPairReport
{
    int m_contacts = 0;      ///< appended
    bool m_limited = false;  ///< more points than allowed were found; those with the smallest gaps were kept
    bool m_thinned = false;  ///< a skin is too fine for all its points to be kept: see ContactReduction
};

/// How far two bodies look for each other; after SoftSurface::place of both.
TouchReach reachBetween(const FemSoftBody& first, const FemSoftBody& second);

/// Finds where the surfaces of two FEM bodies, or of one with itself, touch or may do so within the step: nodes against
/// faces both ways (NodeSurfaceSearch) and ridges against ridges (EdgePairSearch). Gaps are those at the start of the
/// step, less both contact offsets (not for self contact); what closes to less than 5 % of the smaller mean edge
/// within the step, as the surfaces are expected to move, is a contact. Between two bodies, what is inside is led out
/// the short way at any depth up to half a body; self contact believes depths up to half an edge. Friction is the
/// larger kDF, restitution the product of both. Scratch grows, never shrinks; one finder a thread.
class SoftPairFinder
{
public:
    /// `memory` holds the contacts whose impulses are taken over, and must live as long as the finder.
    explicit SoftPairFinder(const SoftPairMemory& memory) : m_memory(&memory) {}

    /// After solveFreeMotion and SoftSurface::update of both. Appends at most maxContacts, ascending by origin; the
    /// first body's point is m_soft of edge pairs, and the node's of the others. Exchanging first and second changes
    /// the order and the roles in edge pairs, not the points. Impulses of remembered contacts are taken over.
    SoftPairReport find(const SoftPairSide& first, const SoftPairSide& second, int maxContacts,
                        std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins);

    /// In place of find() where both have hardly moved since the search that found the last step's contacts: appends
    /// these, with the gaps that they have now between the points and along the normals of then.
    SoftPairReport keep(const SoftPairSide& first, const SoftPairSide& second, int maxContacts,
                        std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins);

private:
    struct Roles  // of touches
    {
        const SoftPairSide& m_soft;
        const SoftPairSide& m_other;
        SoftPairOrigin m_origin;
    };

    void tell(SoftPairReport& report, std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins) const;
    void listHeldEdges();
    static ContactPoint commonOf(const FemSoftBody& first, const FemSoftBody& second);
    void append(const Roles& roles, double offset);
    static Vec3 patchOf(const Roles& roles, const SurfaceTouch& touch, const ContactPoint& contact);
    int remembered(const SoftPairOrigin& origin, const Vec3& normal) const;
    bool thin(const SoftPairSide& first, const SoftPairSide& second);
    void takeOverImpulses();
    void inheritImpulses(const SoftPairSide& first, const SoftPairSide& second);

    NodeSurfaceSearch m_nodesOfFirst, m_nodesOfSecond;
    EdgePairSearch m_edges;
    std::vector<SurfaceTouch> m_touches;
    std::vector<ContactPoint> m_found;
    std::vector<SoftPairOrigin> m_foundOrigins;
    std::vector<int> m_order;
    const SoftPairMemory* m_memory;
    SoftPairMemory::Last m_last;             // of the pair
    std::vector<EdgePair> m_heldEdges;       // of these, that pushed
    std::vector<unsigned char> m_continued;  // of these
    WarmStartTransfer m_transfer;
    ContactReduction m_reduction;
};

}  // namespace bullet_fem
