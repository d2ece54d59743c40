// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/inner_faces.h"

#include <algorithm>

#include "bullet_bridge/contact/rigid/flush_filter.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"

namespace bullet_fem
{
namespace
{

bool isSlowSolid(const ContactTarget& target)
{
    return target.m_kind == TargetKind::slow && isSolid(*target.m_shape->m_shape);
}

// True if a point of a target's surface lies on a face of another target, or below it, that looks the other way.
bool isOnInnerFace(const SearchScope& scope, const std::vector<ContactTarget>& targets, const ContactTarget& target,
                   const Vec3& point, const Vec3& normal)
{
    return std::any_of(targets.begin(), targets.end(),
                       [&](const ContactTarget& other)
                       {
                           SurfaceDistance d;
                           return &other != &target && isSlowSolid(other) &&
                                  pointShapeDistance(*other.m_shape, point, scope.m_advantage, d) &&
                                  d.m_gap <= scope.m_advantage && dot(d.m_normal, normal) < -kCarrierCosine;
                       });
}

// Unit vector into the body at a vertex, or from an exposed inner node to its middle.
Vec3 inwardAt(const SearchScope& scope, int vertex)
{
    const FemSoftBody& fem = scope.fem();
    const std::vector<Vec3>& x = fem.surfacePosition();
    const TriangleRange around = fem.m_surface.topology().trianglesAt(vertex);
    if (around.size() == 0) return unit(scope.m_middle - x[vertex]);
    Vec3 area;
    for (int k : around)
    {
        const Triangle& t = fem.m_surface.topology().triangles()[k];
        area += cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]);
    }
    return -unit(area);
}

// The distance of a point that has sunk in against `held`, from where it came: from the nearest of the points farther
// and farther back of which the shape is on that side. False if there is none within the body's size.
bool distanceFromBefore(const SearchScope& scope, const ContactTarget& target, const Vec3& point, const Vec3& held,
                        SurfaceDistance& d)
{
    for (double lift = scope.m_band; lift < scope.m_size; lift *= 2)
    {
        const Vec3 before = point + lift * held;
        if (!pointShapeDistance(*target.m_shape, before, lift + target.m_reach, d)) return false;
        if (dot(d.m_normal, held) < kCarrierCosine) continue;
        d.m_gap -= lift * dot(d.m_normal, held);
        return true;
    }
    return false;
}

}  // namespace

void turnFromInnerFaces(const SearchScope& scope, const std::vector<ContactTarget>& targets,
                        const std::vector<Vec3>& heldNormal, ContactList& near)
{
    if (targets.size() < 2) return;
    const FemSoftBody& fem = scope.fem();
    for (const ContactTarget& target : targets)
    {
        if (!isSlowSolid(target)) continue;
        for (std::size_t k = target.m_first; k < target.m_end; ++k)
        {
            ContactPoint& contact = near.points()[k];
            const int vertex = near.origins()[k].m_feature;
            const bool isShallow = contact.m_gap <= scope.m_advantage && contact.m_gap >= -scope.m_band;
            if (!isShallow || vertex >= fem.m_surface.topology().vertexCount()) continue;
            const double apart = contact.m_gap + fem.m_settings.m_contactOffset;
            const Vec3 foot = contact.m_point - apart * contact.m_normal;
            if (!isOnInnerFace(scope, targets, target, foot, contact.m_normal)) continue;
            const Vec3& before = heldNormal[vertex];
            const Vec3 held = norm(before) > 0 ? before : inwardAt(scope, vertex);
            SurfaceDistance d;
            if (!distanceFromBefore(scope, target, contact.m_point, held, d)) continue;
            contact.m_normal = d.m_normal;
            contact.m_gap = d.m_gap - fem.m_settings.m_contactOffset;
        }
    }
}

}  // namespace bullet_fem
