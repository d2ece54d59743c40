// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/entered_face.h"

#include <algorithm>

#include "bullet_bridge/contact/rigid/contact_features.h"
#include "bullet_bridge/contact/rigid/flush_filter.h"

namespace bullet_fem
{
namespace
{

// The face that a point of a feature entered a target through.
struct EnteredFace
{
    bool m_exists = false;
    Vec3 m_normal;      // unit, as the target stands
    Vec3 m_lastNormal;  // as it stood in the last search
};

// The first face on the straight way of a point since the last search, as the target saw it.
EnteredFace faceOnWay(const SearchScope& scope, const ContactTarget& target, const Triangle& nodes,
                      const SurfaceDistance& d)
{
    const FemSoftBody& fem = scope.fem();
    const Pose &pose = target.m_shape->m_pose, &last = target.m_last->m_pose;
    const Vec3 point = interpolated(fem.surfacePosition(), nodes, d.m_barycentric);
    const Vec3 before = pose.toWorld(last.toLocal(interpolated(fem.m_memory.m_positions, nodes, d.m_barycentric)));
    const Vec3 way = point - before;
    const bool isBehind = dot(d.m_normal, way) > d.m_gap;  // it was behind the face that is nearest now
    if (!isBehind || !mayHaveGone(scope, target, way)) return {};
    SweptFeature path;
    path.m_position[0] = before;
    path.m_velocity[0] = way;
    SweptContact met;
    const SweptShape still(*target.m_shape, {pose.m_origin, {}, {}}, 1);
    if (!sweptDistance(still, path, fem.m_settings.m_contactOffset, met) || !(met.m_time > 0)) return {};
    const Vec3& normal = met.m_surface.m_normal;
    return {true, normal, last.m_rotation * transposeTimes(pose.m_rotation, normal)};
}

EnteredFace enteredFace(const SearchScope& scope, const ContactTarget& target, int feature, const Triangle& nodes,
                        const SurfaceDistance& d)
{
    const ContactPoint* contact = deepContact(scope.fem(), originOf(target, feature));
    if (contact == nullptr) return faceOnWay(scope, target, nodes, d);
    const Vec3 normal = unit(contact->m_normal);
    const Pose &pose = target.m_shape->m_pose, &last = target.m_last->m_pose;
    return {true, pose.m_rotation * transposeTimes(last.m_rotation, normal), normal};
}

}  // namespace

void turnToEnteredFace(const SearchScope& scope, const ContactTarget& target, int feature, const Triangle& nodes,
                       SurfaceDistance& d)
{
    if (target.m_last == nullptr) return;
    const EnteredFace face = enteredFace(scope, target, feature, nodes, d);
    // A target that rolls on the point turns other faces to it.
    const double cosine = std::max(dot(face.m_normal, d.m_normal), dot(face.m_lastNormal, d.m_normal));
    if (!face.m_exists || cosine >= (d.m_gap < 0 ? kCarrierCosine : kOpposedCosine)) return;
    if (cosine > kOpposedCosine && !(d.m_gap < -scope.m_band)) return;  // a little below a face beside: flush
    const Vec3 point = interpolated(scope.fem().surfacePosition(), nodes, d.m_barycentric);
    SurfaceDistance before;
    if (!distanceFromBefore(scope, target, point, face.m_normal, before)) return;
    before.m_gap -= scope.fem().m_settings.m_contactOffset;
    d.m_gap = before.m_gap;
    d.m_normal = before.m_normal;
}

bool distanceFromBefore(const SearchScope& scope, const ContactTarget& target, const Vec3& point, const Vec3& held,
                        SurfaceDistance& d)
{
    for (double lift = scope.m_band; lift < scope.m_size; lift *= 2)
    {
        const Vec3 before = point + lift * held;
        if (!pointShapeDistance(*target.m_shape, before, lift + target.m_reach, d)) return false;
        const double cosine = dot(d.m_normal, held);
        if (cosine < kCarrierCosine) continue;
        const Vec3 beside = d.m_gap * (d.m_normal - cosine * held);
        if (norm(beside) <= scope.m_advantage)
            d = {d.m_gap * cosine - lift, held, {}};
        else
            d.m_gap -= lift * cosine;
        return true;
    }
    return false;
}

void notePlaces(const std::vector<ContactTarget>& targets, FemSoftBody& fem)
{
    ContactMemory& memory = fem.m_memory;
    memory.m_solids.clear();
    memory.m_positions.clear();
    for (const ContactTarget& target : targets)
        if (isMovableSolid(target))
            memory.m_solids.push_back({broadphaseId(*target.m_object), target.m_leaf, target.m_shape->m_pose});
    if (!memory.m_solids.empty()) memory.m_positions.assign(fem.surfacePosition().begin(), fem.surfacePosition().end());
}

}  // namespace bullet_fem
