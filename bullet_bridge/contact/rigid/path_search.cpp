// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/path_search.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{
namespace
{

constexpr double kRollingGap = 0.1;  // largest approach of a rolling contact within a step, over the body's size
constexpr double kNever = std::numeric_limits<double>::infinity();

/// A target and the surface's motion along the paths.
struct Paths
{
    const SearchScope& m_scope;
    const ContactTarget& m_target;
    const CarriedMotion& m_carried;
    const SweptShape& m_swept;
    const SweptShape* m_stopped;  ///< the target if others stop it; null: none can
    double m_speed;               ///< largest speed of the surface relative to the leaf [m/s]
    double m_clearance;           ///< distance that still counts as meeting [m]
};

// Path of a feature within the step: a vertex with carriers starts lifted off them, and does not enter them. `held`:
// velocity to be added to the free one [m/s].
SweptFeature pathOf(const FemSoftBody& fem, const CarriedMotion& carried, const Triangle& nodes, const Vec3& held,
                    double step)
{
    SweptFeature path;
    path.m_count = nodes[1] == nodes[0] ? 1 : nodes[2] == nodes[0] ? 2 : 3;
    for (int i = 0; i < path.m_count; ++i)
    {
        path.m_position[i] = fem.surfacePosition()[nodes[i]];
        path.m_velocity[i] = fem.surfaceVelocity()[nodes[i]] + held;
        if (!carried.isCarried(nodes[i])) continue;
        path.m_position[i] += carried.liftOf(nodes[i]);
        path.m_velocity[i] = carried.allowed(nodes[i], step * path.m_velocity[i]) * (1 / step);
    }
    return path;
}

bool meetsIfHeld(const Paths& search, const SweptShape& swept, const Triangle& nodes, const Vec3& held,
                 SweptContact& contact)
{
    const FemSoftBody& fem = search.m_scope.fem();
    const SweptFeature path = pathOf(fem, search.m_carried, nodes, held, search.m_target.m_step);
    const double offset = fem.m_settings.m_contactOffset + search.m_clearance;
    if (!mayMeet(swept, path, offset) || !sweptDistance(swept, path, offset, contact)) return false;
    SurfaceDistance& d = contact.m_surface;
    d.m_gap += search.m_clearance;
    if (search.m_target.m_carrying->m_exists && contact.m_time > 0 && !faces(fem, nodes, d.m_normal)) return false;
    for (int i = 0; i < path.m_count; ++i)
        d.m_gap -= d.m_barycentric[i] * dot(d.m_normal, path.m_position[i] - fem.surfacePosition()[nodes[i]]);
    const Vec3 point = interpolated(fem.surfacePosition(), nodes, d.m_barycentric);
    if (isBesideCarryingPlane(search.m_scope, search.m_target, point, d.m_normal, d.m_gap)) return false;
    if (search.m_target.m_carrying->m_exists &&
        dot(d.m_normal, search.m_target.m_carrying->m_normal) > kSameNormalCosine)
        d.m_normal = search.m_target.m_carrying->m_normal;
    return true;
}

// True if a feature meets a movable target that others stop within the step, while the target keeps ahead of it in free
// motion.
bool meetsIfStopped(const Paths& search, const Triangle& nodes, SweptContact& contact)
{
    const ContactTarget& target = search.m_target;
    SweptContact met;
    if (search.m_stopped == nullptr || !meetsIfHeld(search, *search.m_stopped, nodes, {}, met)) return false;
    const FemSoftBody& fem = search.m_scope.fem();
    const SurfaceDistance& d = met.m_surface;
    const Vec3 point = interpolated(fem.surfacePosition(), nodes, d.m_barycentric);
    const Vec3 relative =
        interpolated(fem.surfaceVelocity(), nodes, d.m_barycentric) - target.m_motion->velocityAt(point);
    if (!(met.m_time > 0 && d.m_gap + target.m_step * dot(d.m_normal, relative) >= 0)) return false;
    contact = met;
    return true;
}

// True if a node (three equal indices), edge (first and last equal) or triangle meets a target within the step, in free
// motion, with the fall of one side removed, or if others stop the target. Pairs that overlap as the step begins met
// before it.
bool meets(const Paths& search, const Triangle& nodes, SweptContact& contact)
{
    const auto meetsWith = [&](const Vec3& held) { return meetsIfHeld(search, search.m_swept, nodes, held, contact); };
    const Vec3 given = (1 / search.m_target.m_step) * search.m_target.m_fall;
    return meetsWith({}) || (norm(given) > 0 && (meetsWith(-given) || meetsWith(given))) ||
           meetsIfStopped(search, nodes, contact);
}

// Sets the levers of a contact that is met later in the step to its place at that time, but not those of a nearby
// rolling contact.
void setLevers(const SearchScope& scope, const ContactTarget& target, int feature, const SweptContact& met,
               ContactPoint& contact)
{
    const FemSoftBody& fem = scope.fem();
    const bool isNode = feature < fem.m_surface.topology().vertexCount();
    const PatchPoint point(target, {feature, feature, feature}, {1, 0, 0}, contact.m_normal);
    const Vec3& spin = target.m_motion->m_angularVelocity;
    const bool rolls = (point.m_curvature > 0 && dot(spin, spin) > 0) ||
                       (isNode && roundness(fem.m_surface.curvature().m_largest[feature], scope.m_size) > 0);
    if (isNode) contact.m_patch = patchOf(scope, target, point, met.m_time) - target.m_advance;
    if (rolls && contact.m_gap < kRollingGap * scope.m_size) return;
    if (!isNode) contact.m_patch = {};
    contact.m_isMetLater = true;
    contact.m_approach = target.m_moved + met.m_arm - (contact.m_point + contact.m_patch - target.m_motion->m_center);
}

// Keeps the first point of a feature that is met, if that is before `earliest` [s]. Overlapping points count as met
// earlier the deeper they are. Returns the earlier of the two times.
double considerPath(const Paths& search, int feature, const Triangle& nodes, double earliest, ContactList& list)
{
    FemSoftBody& fem = search.m_scope.fem();
    SweptContact contact;
    if (!meets(search, nodes, contact)) return earliest;
    const double time = contact.m_time > 0 ? contact.m_time : contact.m_surface.m_gap / search.m_speed;
    if (feature < fem.m_surface.topology().vertexCount())
        fem.m_search.m_nodeNormal[nodes[0]] = contact.m_surface.m_normal;
    if (time < earliest - search.m_scope.m_advantage / search.m_speed)
        if (ContactPoint* kept = list.keep(search.m_scope, search.m_target, feature, nodes, contact.m_surface))
            setLevers(search.m_scope, search.m_target, feature, contact, *kept);
    return std::min(time, earliest);
}

// Appends a contact found near, unless it is flush.
void keepNear(const ContactList& near, const FlushFilter& filter, std::size_t k, ContactList& list)
{
    if (!filter.isFlush(k)) list.append(near, k);
}

}  // namespace

void findTouchingNodes(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target, ContactList& near)
{
    const FemSoftBody& fem = scope.fem();
    const double reach =  // a vertex may have passed a movable target since the last search
        (target.m_last != nullptr ? target.m_reach : scope.m_band) + fem.m_settings.m_contactOffset;
    if (!scope.m_culling.meets({target.m_shape->m_boundsMin, target.m_shape->m_boundsMax, reach})) return;
    for (int i : scope.vertices())
    {
        const Vec3& x = fem.surfacePosition()[i];
        SurfaceDistance d;
        if (!scope.m_culling.noteVertex(i, x, x) || !pointShapeDistance(*target.m_shape, x, reach, d)) continue;
        d.m_gap -= fem.m_settings.m_contactOffset;
        innerFaces.turn(scope, target, i, {i, i, i}, d);
        const Vec3 relative = fem.surfaceVelocity()[i] - target.m_motion->velocityAt(x);
        const double closest = d.m_gap + target.m_step * dot(d.m_normal, relative) - norm(target.m_fall);
        const bool parts = d.m_gap > 0 && closest > scope.m_band;
        if (d.m_gap <= scope.m_band && !parts) near.consider(scope, target, i, {i, i, i}, d);
    }
}

void confirmOnPaths(const SearchScope& scope, const ContactTarget& target, const ContactList& near,
                    const FlushFilter& filter, ContactList& list)
{
    const FemSoftBody& fem = scope.fem();
    const bool hasInside = isSolid(*target.m_shape->m_shape);
    std::optional<SweptShape> swept;
    for (std::size_t k = target.m_first; k < target.m_end; ++k)
    {
        if (!hasInside || near.points()[k].m_gap <= scope.m_band)
        {
            keepNear(near, filter, k, list);
            continue;
        }
        if (!swept) swept.emplace(sweptShapeOf(target));
        const int feature = near.origins()[k].m_feature;
        const Triangle corners = cornersOf(fem, target, feature);
        SweptContact contact;
        if (!meets({scope, target, filter.carried(), *swept, nullptr, 0, kNegligibleLength * scope.m_edge}, corners,
                   contact))
            continue;
        if (dot(contact.m_surface.m_normal, near.points()[k].m_normal) > kSameNormalCosine)
            keepNear(near, filter, k, list);
        else
            list.keep(scope, target, feature, corners, contact.m_surface);
    }
}

// Nodes come first; a point of an edge or triangle counts only if it is met before all of the feature's corners and
// edges.
void findOnPaths(SearchScope& scope, const ContactTarget& target, const ContactList& near, const FlushFilter& filter,
                 ContactList& list)
{
    FemSoftBody& fem = scope.fem();
    const SweptShape swept = sweptShapeOf(target);
    const double spin = norm(swept.m_motion.m_angularVelocity) * swept.m_spinRadius;
    const double fall = norm(target.m_fall);
    const double fastest = fastestVertex(fem, swept.m_motion.m_linearVelocity) + fall / target.m_step;
    const SweptShape stopped(*target.m_shape, {target.m_motion->m_center, {}, {}}, target.m_step);
    const Paths search = {scope,          target, filter.carried(), swept, target.m_mayBeStopped ? &stopped : nullptr,
                          fastest + spin, 0};
    scope.m_culling.meets({swept.m_boundsMin, swept.m_boundsMax, fem.m_settings.m_contactOffset + fall});
    std::size_t next = target.m_first;  // in near
    for (int i : scope.vertices())
    {
        const SweptFeature path = pathOf(fem, filter.carried(), {i, i, i}, {}, target.m_step);
        scope.m_culling.noteVertex(i, path.m_position[0], path.m_position[0] + target.m_step * path.m_velocity[0]);
        fem.m_search.m_nodeGap[i] = kNever;
        if (next < target.m_end && near.origins()[next].m_feature == i)
        {
            const ContactPoint& contact = near.points()[next];
            fem.m_search.m_nodeNormal[i] = contact.m_normal;
            if (!filter.isFlush(next))
            {
                fem.m_search.m_nodeGap[i] = contact.m_gap / search.m_speed;
                list.append(near, next);
            }
            ++next;
            continue;
        }
        if (!scope.m_culling.isOutside({i, i, i}))
            fem.m_search.m_nodeGap[i] = considerPath(search, i, {i, i, i}, kNever, list);
    }
    const int edgeCount = fem.m_surface.topology().edgeCount();
    int firstFeature = fem.m_surface.topology().vertexCount() + 1;  // the features of nearest points have odd numbers
    for (int k = 0; k < edgeCount; ++k)
    {
        const auto [a, b] = fem.m_surface.topology().edges()[k];
        fem.m_search.m_edgeGap[k] = std::min(fem.m_search.m_nodeGap[a], fem.m_search.m_nodeGap[b]);
        if (!areOverOneFace(fem, a, b) && !scope.m_culling.isOutside({a, b, a}))
            fem.m_search.m_edgeGap[k] =
                considerPath(search, firstFeature + 2 * k, {a, b, a}, fem.m_search.m_edgeGap[k], list);
    }
    const int triangleCount = fem.m_surface.topology().triangleCount();
    firstFeature += 2 * edgeCount;
    for (int k = 0; k < triangleCount; ++k)
    {
        const Triangle& t = fem.m_surface.topology().triangles()[k];
        if (scope.m_culling.isOutside(t) || (areOverOneFace(fem, t[0], t[1]) && areOverOneFace(fem, t[0], t[2])))
            continue;
        double earliest = kNever;
        for (int a = 0; a < 3; ++a)
            earliest = std::min({earliest, fem.m_search.m_nodeGap[t[a]],
                                 fem.m_search.m_edgeGap[fem.m_surface.topology().edgesOf(k)[a]]});
        considerPath(search, firstFeature + 2 * k, t, earliest, list);
    }
}

}  // namespace bullet_fem
