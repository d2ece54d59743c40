// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/contact_list.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/geometry/shapes/rolling_curvature.h"
#include "bullet_bridge/joints/soft_joints.h"

namespace bullet_fem
{
namespace
{

constexpr double kSlop = 5e-5;         // permitted penetration over the body's size, for objects that cannot move [-]
constexpr double kMovableSlop = 1e-4;  // and for movable objects: position corrections cost angular momentum [-]

// The part of a displacement that the nearest point of an edge or triangle follows: along the edge that it is on, or in
// the triangle.
Vec3 alongFeature(const FemSoftBody& fem, const Triangle& nodes, const FeatureWeights& weights, const Vec3& way)
{
    int inner[3], count = 0;
    for (int a = 0; a < 3; ++a)
        if (weights[a] > 0) inner[count++] = nodes[a];
    if (count == 3) return way;
    if (count < 2) return {};
    const Vec3 edge = fem.surfacePosition()[inner[1]] - fem.surfacePosition()[inner[0]];
    const double square = dot(edge, edge);
    return square > 0 ? (dot(way, edge) / square) * edge : Vec3();
}

// Offset to the patch of a contact at any feature. Flat objects have no nearest points of their own on edges and
// triangles: these move with the patch.
Vec3 patchOfFeature(const SearchScope& scope, const ContactTarget& target, int feature, const PatchPoint& point)
{
    const FemSoftBody& fem = scope.fem();
    if (!(point.m_curvature > 0) && feature >= fem.m_surface.topology().vertexCount()) return {};
    const Vec3 patch = patchOf(scope, target, point, target.m_step);
    if (isFixedPoint(fem, target, feature)) return patch;
    return patch - alongFeature(fem, point.m_nodes, point.m_weights, patch);
}

}  // namespace

PatchPoint::PatchPoint(const ContactTarget& target, const Triangle& nodes, const FeatureWeights& weights,
                       const Vec3& normal)
    : m_nodes(nodes),
      m_weights(weights),
      m_normal(normal),
      m_curvature(rollingCurvature(*target.m_shape, normal, target.m_motion->m_angularVelocity))
{
}

void ContactList::clear()
{
    m_points.clear();
    m_origins.clear();
    m_weights.clear();
}

void ContactList::reserve(std::size_t contacts)
{
    m_points.reserve(contacts);
    m_origins.reserve(contacts);
    m_weights.reserve(contacts);
}

void ContactList::append(const ContactList& other, std::size_t k)
{
    m_points.push_back(other.m_points[k]);
    m_origins.push_back(other.m_origins[k]);
}

void ContactList::consider(const SearchScope& scope, const ContactTarget& target, int feature, const Triangle& nodes,
                           const SurfaceDistance& d)
{
    const FemSoftBody& fem = scope.fem();
    const Vec3 point = interpolated(fem.surfacePosition(), nodes, d.m_barycentric);
    const Vec3 relative =
        interpolated(fem.surfaceVelocity(), nodes, d.m_barycentric) - target.m_motion->velocityAt(point);
    const double closest = d.m_gap + target.m_step * dot(d.m_normal, relative) - norm(target.m_fall);
    if (d.m_gap > scope.m_band && closest > scope.m_band) return;
    // A plane fills all of its half space: a point on its way into one is a contact whatever its normal. Otherwise the
    // core of a body that is crushed within one step would pass the contacts on its surface.
    const double nearest = isPlane(*target.m_shape) ? std::min(d.m_gap, closest) : d.m_gap;
    if (nearest > -scope.m_band && !faces(fem, nodes, d.m_normal)) return;
    keep(scope, target, feature, nodes, d);
}

ContactPoint* ContactList::keep(const SearchScope& scope, const ContactTarget& target, int feature,
                                const Triangle& nodes, const SurfaceDistance& d)
{
    FemSoftBody& fem = scope.fem();
    ContactPoint contact;
    contact.m_soft = fem.pointOn(scope.m_bodyIndex, nodes, d.m_barycentric);
    for (int a = 0; a < contact.m_soft.m_count; ++a)
        if (isAnchoredTo(fem, contact.m_soft.m_nodes[a], *target.m_object)) return nullptr;
    const Vec3& inverseMass = target.m_motion->m_inverseMass;
    contact.m_point = interpolated(fem.surfacePosition(), nodes, d.m_barycentric);
    contact.m_rigidProxy = target.m_rigidProxy;
    if (target.m_object->isKinematicObject()) contact.m_approach = target.m_moved;
    contact.m_patch = patchOfFeature(scope, target, feature, {target, nodes, d.m_barycentric, d.m_normal});
    contact.m_patch -= target.m_advance;
    contact.m_normal = d.m_normal;
    contact.m_gap = d.m_gap + dot(d.m_normal, target.m_advance);
    contact.m_slop = (dot(inverseMass, inverseMass) > 0 ? kMovableSlop : kSlop) * scope.m_size;
    contact.m_friction = target.m_surface.m_friction;
    contact.m_restitution = target.m_surface.m_restitution;
    contact.m_stiffness = target.m_surface.m_stiffness;
    contact.m_damping = target.m_surface.m_damping;
    contact.m_hardness = target.m_surface.m_hardness;
    m_points.push_back(contact);
    m_origins.push_back(originOf(target, feature));
    m_weights.push_back(d.m_barycentric);
    return &m_points.back();
}

Vec3 patchOf(const SearchScope& scope, const ContactTarget& target, const PatchPoint& point, double time)
{
    const FemSoftBody& fem = scope.fem();
    const SurfacePoint at = fem.pointOn(scope.m_bodyIndex, point.m_nodes, point.m_weights);
    ContactPatchSide soft = {at.of(fem.m_body.m_state.m_v), fem.m_search.m_meanMotion.m_spin, 0, scope.m_size,
                             std::nullopt};
    const SurfaceCurvature& curvature = fem.m_surface.curvature();
    for (int a = 0; a < 3; ++a)
    {
        soft.m_curvature += point.m_weights[a] * curvature.m_largest[point.m_nodes[a]];
        if (curvature.m_hasFewFacets[point.m_nodes[a]]) soft.m_ofMass = fem.m_search.m_meanMotion.m_velocity;
    }
    soft.m_curvature = roundness(soft.m_curvature, scope.m_size);
    const double infinite = std::numeric_limits<double>::infinity();
    const bool canMove = !target.m_object->isStaticOrKinematicObject();
    const RigidProxy& motion = *target.m_motion;
    const ContactPatchSide rigid = {
        motion.velocityAt(interpolated(fem.surfacePosition(), point.m_nodes, point.m_weights)),
        motion.m_angularVelocity, point.m_curvature,
        canMove ? norm(target.m_shape->m_boundsMax - target.m_shape->m_boundsMin) : infinite, std::nullopt};
    return patchLag(soft, rigid, point.m_normal, time);
}

}  // namespace bullet_fem
