// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_bridge/contact/rigid/contact_finder.h"

namespace bullet_fem
{
namespace
{

constexpr double kLeastStep = 0.25;  // smallest height of a step above a carrier, over the lift; lower ones are flush
constexpr double kApart = 0.05;      // gap of separated surfaces, over the lift; resting ones have less
constexpr double kFlushReach = 4;    // radius of the search for a wall near a lifted point, over the lift
constexpr double kSunk = 0.2;        // depth to which objects sink into soft bodies that carry them, over the mean edge
constexpr double kAlikeCosine = 0.7;       // smallest cosine of normals of surfaces that carry together
constexpr double kParallelCosine = 0.999;  // smallest cosine of normals of one surface

}  // namespace

// Drops side walls that are flush with a surface that carries the point: they do not obstruct it. Convex shapes beyond
// the contact band are judged by their paths instead.
void ContactFinder::markFlush(FemSoftBody& fem)
{
    m_flush.assign(m_near.size(), 0);
    for (const Target& target : m_targets)
        for (std::size_t k = target.m_first; k < target.m_end; ++k)
            m_flush[k] = isBesideCarryingPlane(target, m_near[k].m_point, m_near[k].m_normal, m_near[k].m_gap);
    addCarriers(fem);
    if (m_targets.empty() || (m_targets.size() == 1 && m_targets.front().m_kind != TargetKind::sheets)) return;
    bool isAny = false;
    for (std::size_t t = 0; t < m_targets.size(); ++t)
        for (std::size_t k = m_targets[t].m_first; k < m_targets[t].m_end; ++k)
        {
            if (m_near[k].m_gap > m_band && m_targets[t].m_kind != TargetKind::sheets) continue;
            if (!m_flush[k]) m_flush[k] = isFlush(fem, m_targets[t], k, surfaceOf(t, k));
            isAny = isAny || m_flush[k];
        }
    if (isAny) addCarriers(fem);
}

// Number of the surface of a contact: a convex shape, or one triangle of a sheet.
int ContactFinder::surfaceOf(std::size_t target, std::size_t k) const
{
    return m_targets[target].m_kind == TargetKind::sheets ? -1 - static_cast<int>(k) : static_cast<int>(target);
}

// Adds the contacts of vertices that touch as carriers.
void ContactFinder::addCarriers(const FemSoftBody& fem)
{
    m_carried.begin(fem.m_surface.vertexCount(), m_band);
    for (std::size_t t = 0; t < m_targets.size(); ++t)
        for (std::size_t k = m_targets[t].m_first; k < m_targets[t].m_end; ++k)
        {
            const ContactPoint& contact = m_near[k];
            if (m_flush[k] || contact.m_gap > m_band || m_nearOrigins[k].m_feature >= fem.m_surface.vertexCount())
                continue;
            m_carried.add(
                m_nearOrigins[k].m_feature,
                {contact.m_normal, contact.m_gap,
                 m_targets[t].m_step * m_targets[t].m_motion->velocityAt(contact.m_point), surfaceOf(t, k), -1});
        }
}

// The corners of a feature; see ContactOrigin::m_feature.
Triangle ContactFinder::cornersOf(const FemSoftBody& fem, const Target& target, int feature)
{
    const SoftSurface& surface = fem.m_surface;
    const std::vector<std::array<int, 2>>& edges = surface.features().m_edges;
    const bool areSheets = target.m_kind == TargetKind::sheets;
    const int vertexCount = surface.vertexCount(), edgeCount = static_cast<int>(edges.size());
    if (feature < vertexCount) return {feature, feature, feature};
    if (!areSheets && feature >= firstCornerFeature(fem)) return surface.triangles()[triangleOfCorner(fem, feature)];
    const int k = areSheets ? feature - vertexCount : (feature - vertexCount) / 2;
    const int edge = areSheets ? k - static_cast<int>(surface.triangles().size()) : k;
    if (edge >= 0 && edge < edgeCount) return {edges[edge][0], edges[edge][1], edges[edge][0]};
    return surface.triangles()[areSheets ? k : k - edgeCount];
}

bool ContactFinder::isFlush(FemSoftBody& fem, const Target& target, std::size_t k, int surface)
{
    const ContactPoint& contact = m_near[k];
    const Triangle corners = cornersOf(fem, target, m_nearOrigins[k].m_feature);
    bool flush = false;
    for (int a = 0; a < 3 && !flush; ++a)
    {
        const Vec3& x = fem.surfacePosition()[corners[a]];
        const auto check = [&](const CarriedMotion::Carrier& c)
        {
            const double cosine = dot(contact.m_normal, c.m_normal);
            if (flush || c.m_surface == surface || cosine < kOpposedCosine || cosine > kParallelCosine) return;
            flush = cosine < kAlikeCosine ? isFlushWith(target, contact, x - c.m_gap * c.m_normal, c.m_normal)
                                          : isPassed(fem, target, k, surface);
        };
        m_carried.forEach(corners[a], check);
    }
    return flush;
}

// True if a point is beside the plane on which an object slides over soft bodies: the object sinks in, so the
// neighbouring surface rises a little above that plane.
bool ContactFinder::isBesideCarryingPlane(const Target& target, const Vec3& point, const Vec3& normal, double gap) const
{
    const CarryingPlane& plane = *target.m_carrying;
    if (!plane.m_exists) return false;
    const double cosine = dot(normal, plane.m_normal);
    return cosine > kOpposedCosine && cosine < (gap > 0 ? kParallelCosine : kAlikeCosine) &&
           plane.m_distance - dot(plane.m_normal, point) < kSunk * m_edge;
}

// True if the target does not rise near the contact above the plane that carries the point.
bool ContactFinder::isFlushWith(const Target& target, const ContactPoint& contact, const Vec3& onPlane,
                                const Vec3& normal)
{
    const double height = dot(normal, contact.m_point - onPlane);
    const Vec3 lifted = contact.m_point + std::max(0.0, m_carried.lift() - height) * normal;
    Vec3 nearest;
    if (!nearestOn(target, lifted, contact, nearest)) return true;
    return dot(normal, nearest - onPlane) < kLeastStep * m_carried.lift();
}

// True if a contact is separated now, and will be at the point to which the other carriers lead.
bool ContactFinder::isPassed(const FemSoftBody& fem, const Target& target, std::size_t k, int surface)
{
    const double apart = kApart * m_carried.lift();
    const ContactPoint& contact = m_near[k];
    if (!(contact.m_gap > apart)) return false;
    const Triangle corners = cornersOf(fem, target, m_nearOrigins[k].m_feature);
    Vec3 way = -target.m_step * target.m_motion->velocityAt(contact.m_point);
    for (int a = 0; a < 3; ++a)
        way += m_nearWeights[k][a] *
               m_carried.allowed(corners[a], target.m_step * fem.surfaceVelocity()[corners[a]], surface);
    Vec3 nearest;
    const Vec3 end = contact.m_point + way;
    if (!nearestOn(target, end, contact, nearest)) return true;
    const Vec3 off = end - nearest;
    return dot(off, contact.m_normal) > 0 && norm(off) - fem.m_contactOffset > apart;
}

// The point of a target that is nearest to `point`; of sheets, only triangles of about the contact's normal count.
bool ContactFinder::nearestOn(const Target& target, const Vec3& point, const ContactPoint& contact, Vec3& nearest)
{
    const double reach = kFlushReach * m_carried.lift() + std::fabs(contact.m_gap);
    if (target.m_kind != TargetKind::sheets)
    {
        SurfaceDistance d;
        if (!pointShapeDistance(*target.m_shape, point, reach, d)) return false;
        nearest = point - d.m_gap * d.m_normal;
        return true;
    }
    const Vec3 box = {reach, reach, reach};
    m_soup.collect(*target.m_shape, point - box, point + box);
    double distance = reach;
    for (const SoupTriangle& triangle : m_soup.triangles())
    {
        if (std::fabs(dot(triangle.m_normal, contact.m_normal)) < kAlikeCosine) continue;
        const Vec3 on = bullet_fem::nearestOn(triangle, point).m_point;
        if (!(norm(point - on) < distance)) continue;
        distance = norm(point - on);
        nearest = on;
    }
    return distance < reach;
}

}  // namespace bullet_fem
