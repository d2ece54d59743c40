// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <tuple>

#include "bullet_bridge/contact_heirs.h"
#include "bullet_bridge/fem_soft_body.h"
#include "bullet_bridge/soft_pairs/edge_pair_search.h"

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
};

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
};

/// Finds where the surfaces of two FEM bodies, or of one with itself, touch or may do so within the step: nodes against
/// faces both ways (NodeSurfaceSearch) and ridges against ridges (EdgePairSearch). Gaps are those at the start of the
/// step, less both contact offsets (not for self contact); what closes to less than 5 % of the smaller mean edge
/// within the step, moving as it would freely, is a contact. Between two bodies, what is inside is led out the short
/// way at any depth up to half a body; self contact believes depths up to half an edge. Friction is the larger kDF,
/// restitution the product of both. Scratch grows, never shrinks; one finder a thread.
class SoftPairFinder
{
public:
    /// After solveFreeMotion and SoftSurface::update of both. Appends at most maxContacts, ascending by origin; the
    /// first body's point is m_soft of edge pairs, and the node's of the others. Exchanging first and second changes
    /// the order and the roles in edge pairs, not the points. Impulses of remembered contacts are taken over.
    SoftPairReport find(const SoftPairSide& first, const SoftPairSide& second, int maxContacts,
                        std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins);

    /// What was remembered becomes what is taken over from: at the start of a step.
    void beginStep();

    /// Keeps solved contacts for the next step: one origin a contact, each once.
    void remember(const std::vector<ContactPoint>& contacts, const std::vector<SoftPairOrigin>& origins);

private:
    struct Roles  // of touches
    {
        const SoftPairSide& m_soft;
        const SoftPairSide& m_other;
        SoftPairOrigin m_origin;
    };

    void append(const Roles& roles, double offset);
    int remembered(const SoftPairOrigin& origin, const Vec3& normal) const;
    void findLastOf(const SoftPairSide& first, const SoftPairSide& second);
    void takeOverImpulses();
    void inheritImpulses(const SoftPairSide& first, const SoftPairSide& second);

    NodeSurfaceSearch m_nodesOfFirst, m_nodesOfSecond;
    EdgePairSearch m_edges;
    std::vector<SurfaceTouch> m_touches;
    std::vector<ContactPoint> m_found, m_last, m_next;
    std::vector<SoftPairOrigin> m_foundOrigins, m_lastOrigins, m_nextOrigins;
    std::vector<int> m_order;
    std::vector<unsigned char> m_continued;      // of m_last
    std::size_t m_firstLast = 0, m_endLast = 0;  // the pair's in m_last
    ContactHeirs m_heirs;
};

}  // namespace bullet_fem
