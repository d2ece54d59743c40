// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/soft_pair_finder.h"

#include <algorithm>
#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/contact/friction.h"
#include "bullet_bridge/contact/nearest_contacts.h"
#include "bullet_bridge/contact/soft/deep_pair_search.h"
#include "bullet_bridge/geometry/tolerances.h"
#include "bullet_bridge/joints/node_attachments.h"
#include "bullet_bridge/joints/welds.h"
#include "bullet_bridge/rigid/rigid_proxies.h"

namespace bullet_fem
{
namespace
{

constexpr double kLittleFall = 0.25;  // largest negligible fall in a step over that edge [-]; see fallsFar()

// Sum of both contact offsets [m]; 0 for self contact.
double offsetBetween(const FemSoftBody& first, const FemSoftBody& second)
{
    return &first == &second ? 0 : first.m_settings.m_contactOffset + second.m_settings.m_contactOffset;
}

// Displacement by gravity within the step [m], or 0 if it is negligible. In free motion both bodies fall; contact may
// support the lower one.
double fallBetween(const FemSoftBody& first, const FemSoftBody& second, double edge)
{
    const double step = first.m_surface.step(), fall = step * step * norm(first.gravity());
    return &first != &second && fall > kLittleFall * edge && std::isfinite(fall) ? fall : 0;
}

Vec3 velocityOf(const FemSoftBody& fem)
{
    return fem.m_search.m_meanMotion.m_velocity;
}

}  // namespace

ContactReach reachBetween(const FemSoftBody& first, const FemSoftBody& second)
{
    const double edge = std::min(first.m_surface.meanEdge(), second.m_surface.meanEdge());
    return {kContactBand * edge + offsetBetween(first, second), edge, fallBetween(first, second, edge)};
}

SoftPairReport SoftPairFinder::find(const SoftPairSide& first, const SoftPairSide& second, int maxContacts,
                                    std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins)
{
    m_found.clear();
    m_foundOrigins.clear();
    const bool self = &first.m_fem == &second.m_fem;
    const SoftSurface &a = first.m_fem.m_surface, &b = second.m_fem.m_surface;
    const double offset = offsetBetween(first.m_fem, second.m_fem);
    const ContactReach reach = reachBetween(first.m_fem, second.m_fem);
    Roles roles = {first, second, {}};
    roles.m_origin.m_firstId = broadphaseId(*first.m_fem.m_softBody);
    roles.m_origin.m_secondId = broadphaseId(*second.m_fem.m_softBody);

    m_touches.clear();
    m_nodesOfFirst.find(a, b, reach, nullptr, m_touches);
    append(roles, offset);
    if (!self)
    {
        m_touches.clear();
        m_nodesOfSecond.find(b, a, reach, &m_nodesOfFirst, m_touches);
        append({second, first, {roles.m_origin.m_firstId, roles.m_origin.m_secondId, SoftPairKind::nodeOfSecond, 0, 0}},
               offset);
    }
    m_touches.clear();
    m_last = m_memory->lastOf(roles.m_origin.m_firstId, roles.m_origin.m_secondId);
    listHeldEdges();
    m_edges.find(a, b, reach, {m_nodesOfFirst, self ? m_nodesOfFirst : m_nodesOfSecond}, m_heldEdges, m_touches);
    roles.m_origin.m_kind = SoftPairKind::edges;
    append(roles, offset);

    if (!self)
    {
        dropSeams(first, second, reach, true);
        dropSeams(second, first, reach, false);
    }
    if (!self) partDeep({first, second, roles.m_origin}, reach, offset);

    SoftPairReport report;
    m_continued.assign(m_last.m_count, 0);
    report.m_thinned = thin(first, second);
    report.m_limited = limit(first, second, maxContacts);
    transferImpulses();
    inheritImpulses(first, second);
    tell(report, contacts, origins);
    return report;
}

// Drops contacts beside the face by which a body slides on others, if the other body of this pair does not rise above
// that face by more than bodies sink in: its side ends flush with the ground.
void SoftPairFinder::dropSeams(const SoftPairSide& slider, const SoftPairSide& ground, const ContactReach& reach,
                               bool isFirst)
{
    const CarryingPlane& plane = slider.m_carrying;
    if (!plane.m_exists) return;
    const Vec3 relative = velocityOf(slider.m_fem) - velocityOf(ground.m_fem);
    const double step = slider.m_fem.m_surface.step();
    const double slop = kSoftSlop * std::min(slider.m_fem.m_surface.size(), ground.m_fem.m_surface.size());
    const auto isBeside = [&](std::size_t k)
    {
        const bool softIsFirst = m_foundOrigins[k].m_kind != SoftPairKind::nodeOfSecond;
        const Vec3 outward = softIsFirst == isFirst ? -m_found[k].m_normal : m_found[k].m_normal;
        return std::fabs(dot(outward, plane.m_normal)) < kCarrierCosine;
    };
    const auto isWall = [&](std::size_t k)
    { return plane.m_distance - dot(plane.m_normal, m_found[k].m_point) > kSunk * reach.m_edge; };
    const double along = dot(relative, plane.m_normal), across = norm(relative - along * plane.m_normal);
    if (!(step * across > slop) || across < std::fabs(along)) return;  // it does not slide
    for (std::size_t k = 0; k < m_found.size(); ++k)
        if (isBeside(k) && isWall(k)) return;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < m_found.size(); ++k)
    {
        if (isBeside(k)) continue;
        m_found[kept] = m_found[k];
        m_foundOrigins[kept++] = m_foundOrigins[k];
    }
    m_found.resize(kept);
    m_foundOrigins.resize(kept);
}

// Replaces the contacts of bodies that are so far inside each other that none shows a way out.
void SoftPairFinder::partDeep(Roles roles, const ContactReach& reach, double offset)
{
    const auto isOut = [&](const ContactPoint& contact) { return contact.m_gap < -reach.m_band; };
    if (std::any_of(m_found.begin(), m_found.end(), isOut)) return;
    const SoftSurface &a = roles.m_soft.m_fem.m_surface, &b = roles.m_other.m_fem.m_surface;
    if (!areDeepInside(a, b)) return;
    m_found.clear();
    m_foundOrigins.clear();
    const Vec3 way = wayApart(b, a);
    m_touches.clear();
    findAlong(a, b, way, m_touches);
    roles.m_origin.m_kind = SoftPairKind::nodeOfFirst;
    append(roles, offset);
    m_touches.clear();
    findAlong(b, a, -way, m_touches);
    append({roles.m_other,
            roles.m_soft,
            {roles.m_origin.m_firstId, roles.m_origin.m_secondId, SoftPairKind::nodeOfSecond, 0, 0}},
           offset);
}

SoftPairReport SoftPairFinder::keep(const SoftPairSide& first, const SoftPairSide& second, int maxContacts,
                                    std::vector<ContactPoint>& contacts, std::vector<SoftPairOrigin>& origins)
{
    m_last = m_memory->lastOf(broadphaseId(*first.m_fem.m_softBody), broadphaseId(*second.m_fem.m_softBody));
    m_found.assign(m_last.m_count, commonOf(first.m_fem, second.m_fem));
    m_foundOrigins.assign(m_last.m_origins, m_last.m_origins + m_last.m_count);
    const double offset = offsetBetween(first.m_fem, second.m_fem);
    for (std::size_t k = 0; k < m_last.m_count; ++k)
    {
        const bool ofSecond = m_foundOrigins[k].m_kind == SoftPairKind::nodeOfSecond;
        const SoftPairSide &soft = ofSecond ? second : first, &other = ofSecond ? first : second;
        const ContactPoint& last = m_last.m_contacts[k];
        const Vec3 on = last.m_soft.of(soft.m_fem.m_body.m_state.m_x);
        const Vec3 onOther = last.m_other.of(other.m_fem.m_body.m_state.m_x);
        ContactPoint& contact = m_found[k];
        contact.m_soft = last.m_soft;
        contact.m_other = last.m_other;
        contact.m_soft.m_body = soft.m_index;
        contact.m_other.m_body = other.m_index;
        contact.m_point = 0.5 * (on + onOther);
        contact.m_normal = last.m_normal;
        contact.m_gap = dot(last.m_normal, on - onOther) - offset;
        contact.m_impulse = last.m_impulse;
        contact.m_slip = last.m_slip;
    }
    SoftPairReport report;
    m_continued.assign(m_last.m_count, 0);
    report.m_limited = limit(first, second, maxContacts);
    tell(report, contacts, origins);
    return report;
}

void SoftPairFinder::tell(SoftPairReport& report, std::vector<ContactPoint>& contacts,
                          std::vector<SoftPairOrigin>& origins) const
{
    report.m_contacts = static_cast<int>(m_found.size());
    contacts.insert(contacts.end(), m_found.begin(), m_found.end());
    origins.insert(origins.end(), m_foundOrigins.begin(), m_foundOrigins.end());
}

void SoftPairFinder::listHeldEdges()
{
    m_heldEdges.clear();
    for (std::size_t k = 0; k < m_last.m_count; ++k)
    {
        const SoftPairOrigin& origin = m_last.m_origins[k];
        if (origin.m_kind == SoftPairKind::edges && isPushing(m_last.m_contacts[k]))
            m_heldEdges.push_back({origin.m_feature, origin.m_otherFeature});
    }
}

// The contact parameters that all contacts of two bodies share.
ContactPoint SoftPairFinder::commonOf(const FemSoftBody& first, const FemSoftBody& second)
{
    const btSoftBody &a = *first.m_softBody, &b = *second.m_softBody;
    ContactPoint common;
    common.m_slop = kSoftSlop * std::min(first.m_surface.size(), second.m_surface.size());
    common.m_hardness = std::max(0.0, double(std::min(a.m_cfg.kSHR, b.m_cfg.kSHR)));
    common.m_friction = frictionBetween(a, b);
    common.m_restitution = std::max(0.0, std::min(1.0, double(a.getRestitution()) * b.getRestitution()));
    return common;
}

// Offset from a node's contact point to the contact patch at the end of the step.
Vec3 SoftPairFinder::patchOf(const Roles& roles, const SurfaceContact& touch, const ContactPoint& contact)
{
    const auto sideOf = [](const FemSoftBody& fem, const SurfacePoint& point, const Triangle& nodes,
                           const std::array<double, 3>& weights)
    {
        ContactPatchSide side = {point.of(fem.m_body.m_state.m_v), fem.m_search.m_meanMotion.m_spin, 0,
                                 fem.m_surface.size(), std::nullopt};
        for (int a = 0; a < 3; ++a)
        {
            side.m_curvature += weights[a] * fem.m_surface.curvature().m_largest[nodes[a]];
            if (fem.m_surface.curvature().m_hasFewFacets[nodes[a]])
                side.m_ofMass = fem.m_search.m_meanMotion.m_velocity;
        }
        side.m_curvature = roundness(side.m_curvature, side.m_size);
        return side;
    };
    return patchLag(sideOf(roles.m_soft.m_fem, contact.m_soft, touch.m_nodes, touch.m_weights),
                    sideOf(roles.m_other.m_fem, contact.m_other, touch.m_otherNodes, touch.m_otherWeights),
                    touch.m_normal, roles.m_soft.m_fem.m_surface.step());
}

void SoftPairFinder::append(const Roles& roles, double offset)
{
    const SoftSurface &soft = roles.m_soft.m_fem.m_surface, &other = roles.m_other.m_fem.m_surface;
    const ContactPoint common = commonOf(roles.m_soft.m_fem, roles.m_other.m_fem);
    for (const SurfaceContact& touch : m_touches)
    {
        ContactPoint contact = common;
        contact.m_soft = roles.m_soft.m_fem.pointOn(roles.m_soft.m_index, touch.m_nodes, touch.m_weights);
        contact.m_other = roles.m_other.m_fem.pointOn(roles.m_other.m_index, touch.m_otherNodes, touch.m_otherWeights);
        if (isPointAttached(roles.m_soft.m_fem, contact.m_soft, roles.m_other.m_fem) ||
            isPointAttached(roles.m_other.m_fem, contact.m_other, roles.m_soft.m_fem) ||
            areWelded(roles.m_soft.m_fem, contact.m_soft, roles.m_other.m_fem, contact.m_other))
            continue;
        contact.m_point = 0.5 * (interpolated(soft.position(), touch.m_nodes, touch.m_weights) +
                                 interpolated(other.position(), touch.m_otherNodes, touch.m_otherWeights));
        contact.m_normal = touch.m_normal;
        if (roles.m_origin.m_kind != SoftPairKind::edges) contact.m_patch = patchOf(roles, touch, contact);
        contact.m_gap = touch.m_gap - offset;
        SoftPairOrigin origin = roles.m_origin;
        origin.m_feature = touch.m_feature;
        origin.m_otherFeature = touch.m_otherFeature;
        m_found.push_back(contact);
        m_foundOrigins.push_back(origin);
    }
}

// Thins the contacts of a fine surface. False if neither surface is fine.
bool SoftPairFinder::thin(const SoftPairSide& first, const SoftPairSide& second)
{
    const double cells[2] = {ContactReduction::cellOf(first.m_fem), ContactReduction::cellOf(second.m_fem)};
    if (!(cells[0] > 0 || cells[1] > 0)) return false;
    const bool byFirst = cells[0] > 0 && !(cells[1] > 0 && cells[1] < cells[0]);
    listForReduction(first, second, byFirst, byFirst ? cells[0] : cells[1]);
    m_reduction.thin(m_found, m_foundOrigins);
    return true;
}

// As ContactFinder::limit().
bool SoftPairFinder::limit(const SoftPairSide& first, const SoftPairSide& second, int maxContacts)
{
    if (static_cast<int>(m_found.size()) <= maxContacts) return false;
    listForReduction(first, second, true, ContactReduction::smallestCellOf(first.m_fem));
    m_reduction.limit(maxContacts, m_found, m_foundOrigins);
    keepNearest(maxContacts, m_order, m_found, m_foundOrigins);
    return true;
}

// Lists the contacts by their points in the rest shape of one of the bodies.
void SoftPairFinder::listForReduction(const SoftPairSide& first, const SoftPairSide& second, bool byFirst, double cell)
{
    const FemSoftBody& fem = (byFirst ? first : second).m_fem;
    m_reduction.clear(cell);
    const std::vector<Vec3>& X = fem.m_body.m_model->mesh().restPositions();
    for (std::size_t k = 0; k < m_found.size(); ++k)
    {
        const ContactPoint& contact = m_found[k];
        const bool softIsFirst = m_foundOrigins[k].m_kind != SoftPairKind::nodeOfSecond;
        const SurfacePoint& point = softIsFirst == byFirst ? contact.m_soft : contact.m_other;
        const int last = remembered(m_foundOrigins[k], contact.m_normal);
        m_reduction.add({0, contact, point.of(X), contact.m_gap, last >= 0 && isPushing(m_last.m_contacts[last])});
    }
}

void SoftPairFinder::transferImpulses()
{
    for (std::size_t k = 0; k < m_found.size(); ++k)
    {
        const int last = remembered(m_foundOrigins[k], m_found[k].m_normal);
        if (last < 0) continue;
        m_continued[last] = 1;
        m_found[k].m_impulse = m_last.m_contacts[last].m_impulse;
        m_found[k].m_slip = m_last.m_contacts[last].m_slip;
    }
}

// The contact of the last step that this one continues: that of the pair of edges, or of the node with any face, with a
// similar normal. Returns its index, or -1.
int SoftPairFinder::remembered(const SoftPairOrigin& origin, const Vec3& normal) const
{
    SoftPairOrigin from = origin;
    if (origin.m_kind != SoftPairKind::edges) from.m_otherFeature = -1;
    double best = kSameNormalCosine;
    int found = -1;
    const SoftPairOrigin* const end = m_last.m_origins + m_last.m_count;
    for (const SoftPairOrigin* at = std::lower_bound(m_last.m_origins, end, from); at != end; ++at)
    {
        SoftPairOrigin same = *at;
        same.m_otherFeature = from.m_otherFeature;
        const bool isSame = origin.m_kind == SoftPairKind::edges ? !(from < *at) : !(from < same);
        if (!isSame) break;
        const int candidate = static_cast<int>(at - m_last.m_origins);
        const double alike = dot(m_last.m_contacts[candidate].m_normal, normal);
        if (alike <= best || m_continued[candidate]) continue;
        best = alike;
        found = candidate;
    }
    return found;
}

// Transfers impulses of contacts that no longer exist to new contacts nearby.
void SoftPairFinder::inheritImpulses(const SoftPairSide& first, const SoftPairSide& second)
{
    const auto isSecond = [](const SoftPairOrigin& origin) { return origin.m_kind == SoftPairKind::nodeOfSecond; };
    m_transfer.clear(m_last.m_count);
    for (std::size_t k = 0; k < m_last.m_count; ++k)
    {
        if (m_continued[k]) continue;
        const bool ofSecond = isSecond(m_last.m_origins[k]);
        const FemSoftBody& fem = (ofSecond ? second : first).m_fem;
        const double sign = ofSecond ? -1 : 1;
        const ContactPoint& last = m_last.m_contacts[k];
        m_transfer.addLost(last.m_soft.of(fem.m_skin ? fem.m_body.m_state.m_x : fem.m_surface.position()),
                           sign * last.m_normal, sign * last.m_impulse);
    }
    for (std::size_t k = 0; k < m_found.size(); ++k)
        m_transfer.addCandidate(m_found[k], isSecond(m_foundOrigins[k]) ? -1 : 1);
    const auto edgeOf = [](const SoftPairSide& side) { return side.m_fem.m_body.m_model->mesh().meanEdgeLength(); };
    m_transfer.assign(std::max(edgeOf(first), edgeOf(second)));
}

}  // namespace bullet_fem
