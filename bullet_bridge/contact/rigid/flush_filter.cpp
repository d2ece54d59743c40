// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/flush_filter.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr double kMinStep = 0.25;  // smallest height of a step above a carrier, over the lift; lower ones are flush
constexpr double kApart = 0.05;    // gap of separated surfaces, over the lift; resting ones have less
constexpr double kFlushReach = 4;  // radius of the search for a wall near a lifted point, over the lift

// Number of the surface of contact k: a convex shape, or one triangle of a sheet.
int surfaceNumber(const std::vector<ContactTarget>& targets, std::size_t target, std::size_t k)
{
    return targets[target].m_kind == TargetKind::sheets ? -1 - static_cast<int>(k) : static_cast<int>(target);
}

}  // namespace

void FlushFilter::reserve(std::size_t contacts)
{
    m_flush.reserve(contacts);
    m_carried.reserve(contacts);
}

void FlushFilter::judge(const SearchScope& scope, const std::vector<ContactTarget>& targets, const ContactList& near)
{
    const std::vector<ContactPoint>& points = near.points();
    m_flush.assign(near.size(), 0);
    for (const ContactTarget& target : targets)
        for (std::size_t k = target.m_first; k < target.m_end; ++k)
            m_flush[k] = isBesideCarryingPlane(scope, target, points[k].m_point, points[k].m_normal, points[k].m_gap);
    addCarriers(scope, targets, near);
    if (targets.empty() || (targets.size() == 1 && targets.front().m_kind != TargetKind::sheets)) return;
    bool isAny = false;
    for (std::size_t t = 0; t < targets.size(); ++t)
        for (std::size_t k = targets[t].m_first; k < targets[t].m_end; ++k)
        {
            if (points[k].m_gap > scope.m_band && targets[t].m_kind != TargetKind::sheets) continue;
            if (!m_flush[k])
                m_flush[k] = isFlushWithCarriers(
                    scope, {targets[t], points[k], cornersOf(scope.fem(), targets[t], near.origins()[k].m_feature),
                            near.weights(k), surfaceNumber(targets, t, k)});
            isAny = isAny || m_flush[k];
        }
    if (isAny) addCarriers(scope, targets, near);
}

// Adds the present contacts of vertices as carriers.
void FlushFilter::addCarriers(const SearchScope& scope, const std::vector<ContactTarget>& targets,
                              const ContactList& near)
{
    const int vertexCount = scope.fem().m_surface.topology().vertexCount();
    m_carried.begin(vertexCount, scope.m_band);
    for (std::size_t t = 0; t < targets.size(); ++t)
        for (std::size_t k = targets[t].m_first; k < targets[t].m_end; ++k)
        {
            const ContactPoint& contact = near.points()[k];
            const int feature = near.origins()[k].m_feature;
            if (m_flush[k] || contact.m_gap > scope.m_band || feature >= vertexCount) continue;
            m_carried.add(feature, {contact.m_normal, contact.m_gap,
                                    targets[t].m_step * targets[t].m_motion->velocityAt(contact.m_point),
                                    surfaceNumber(targets, t, k), -1});
        }
}

bool FlushFilter::isFlushWithCarriers(const SearchScope& scope, const Candidate& candidate)
{
    const ContactPoint& contact = candidate.m_contact;
    const Triangle& corners = candidate.m_corners;
    // An edge crosses the rim of a flush wall beside the vertex that slides; farther away it crosses a rim of its own.
    const bool isCrossing =
        candidate.m_target.m_kind == TargetKind::sheets && corners[1] != corners[0] && corners[2] == corners[0];
    bool flush = false;
    for (int a = 0; a < 3 && !flush; ++a)
    {
        const Vec3& x = scope.fem().surfacePosition()[corners[a]];
        if (isCrossing && norm(contact.m_point - x) > m_carried.lift()) continue;
        const auto check = [&](const CarriedMotion::Carrier& c)
        {
            const double cosine = dot(contact.m_normal, c.m_normal);
            if (flush || c.m_surface == candidate.m_surface || cosine < kOpposedCosine || cosine > kParallelCosine)
                return;
            flush = cosine < kCarrierCosine
                        ? isFlushWith(candidate.m_target, contact, x - c.m_gap * c.m_normal, c.m_normal)
                        : isBehindPath(scope, candidate);
        };
        m_carried.forEach(corners[a], check);
    }
    return flush;
}

bool isBesideCarryingPlane(const SearchScope& scope, const ContactTarget& target, const Vec3& point, const Vec3& normal,
                           double gap)
{
    const CarryingPlane& plane = *target.m_carrying;
    if (!plane.m_exists) return false;
    const double cosine = dot(normal, plane.m_normal);
    return cosine > kOpposedCosine && cosine < (gap > 0 ? kParallelCosine : kCarrierCosine) &&
           plane.m_distance - dot(plane.m_normal, point) < kSunk * scope.m_edge;
}

// True if the target does not rise near the contact above the plane that carries the point. The faces of a steep ridge
// are no walls that a contact with it shows: there the ridge itself counts.
bool FlushFilter::isFlushWith(const ContactTarget& target, const ContactPoint& contact, const Vec3& onPlane,
                              const Vec3& normal)
{
    const double height = dot(normal, contact.m_point - onPlane);
    const Vec3 lifted = contact.m_point + std::max(0.0, m_carried.lift() - height) * normal;
    Vec3 nearest;
    if (!nearestOn(target, lifted, contact, nearest)) nearest = contact.m_point - contact.m_gap * contact.m_normal;
    return dot(normal, nearest - onPlane) < kMinStep * m_carried.lift();
}

// True if a contact is separated now, and will be at the point to which the other carriers lead.
bool FlushFilter::isBehindPath(const SearchScope& scope, const Candidate& candidate)
{
    const FemSoftBody& fem = scope.fem();
    const ContactTarget& target = candidate.m_target;
    const double apart = kApart * m_carried.lift();
    const ContactPoint& contact = candidate.m_contact;
    if (!(contact.m_gap > apart)) return false;
    const Triangle& corners = candidate.m_corners;
    Vec3 way = -target.m_step * target.m_motion->velocityAt(contact.m_point);
    for (int a = 0; a < 3; ++a)
        way += candidate.m_weights[a] *
               m_carried.allowed(corners[a], target.m_step * fem.surfaceVelocity()[corners[a]], candidate.m_surface);
    Vec3 nearest;
    const Vec3 end = contact.m_point + way;
    if (!nearestOn(target, end, contact, nearest)) return true;
    const Vec3 off = end - nearest;
    return dot(off, contact.m_normal) > 0 && norm(off) - fem.m_settings.m_contactOffset > apart;
}

// The point of a target that is nearest to `point`; of sheets, only triangles of about the contact's normal count.
bool FlushFilter::nearestOn(const ContactTarget& target, const Vec3& point, const ContactPoint& contact, Vec3& nearest)
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
        if (std::fabs(dot(triangle.m_normal, contact.m_normal)) < kCarrierCosine) continue;
        const Vec3 on = bullet_fem::nearestOn(triangle, point).m_point;
        if (!(norm(point - on) < distance)) continue;
        distance = norm(point - on);
        nearest = on;
    }
    return distance < reach;
}

}  // namespace bullet_fem
