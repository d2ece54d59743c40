// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/inner_faces.h"

#include "bullet_bridge/contact/rigid/entered_face.h"
#include "bullet_bridge/contact/rigid/flush_filter.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"

namespace bullet_fem
{
namespace
{

// True if the shapes keep their places to each other: parts of one object, or objects that nothing moves. Objects that
// touch a body on two sides, as boxes that crush it, are no solid together.
bool areOneSolid(const ContactTarget& a, const ContactTarget& b)
{
    return a.m_object == b.m_object || !(a.m_motion->canMove() || b.m_motion->canMove());
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

}  // namespace

void InnerFaces::turn(const SearchScope& scope, const ContactTarget& target, int feature, const Triangle& nodes,
                      SurfaceDistance& d) const
{
    turnToEnteredFace(scope, target, feature, nodes, d);
    if (m_targets.size() < 2 || !(d.m_gap <= scope.m_advantage && d.m_gap >= -scope.m_band)) return;
    if (!isSolid(*target.m_shape->m_shape)) return;
    const Vec3 held = heldAt(scope, nodes, d.m_barycentric);
    if (norm(held) == 0 || dot(held, d.m_normal) > kParallelCosine) return;
    const double offset = scope.fem().m_settings.m_contactOffset;
    const Vec3 point = interpolated(scope.fem().surfacePosition(), nodes, d.m_barycentric);
    const Beside beside = besideOf(scope, target, point - (d.m_gap + offset) * d.m_normal, d.m_normal);
    SurfaceDistance before;
    if (beside == Beside::none || !distanceFromBefore(scope, target, point, held, before)) return;
    before.m_gap -= offset;
    if (beside != Beside::innerFace && before.m_gap < -scope.m_advantage) return;
    d.m_gap = before.m_gap;
    d.m_normal = before.m_normal;
}

// The place of a point of a target's surface: away from the rest of its solid, on the surface of a part or below it, or
// on a face of one that looks the other way.
InnerFaces::Beside InnerFaces::besideOf(const SearchScope& scope, const ContactTarget& target, const Vec3& foot,
                                        const Vec3& normal) const
{
    Beside beside = Beside::none;
    for (const ContactTarget& other : m_targets)
    {
        SurfaceDistance d;
        if (&other == &target || !areOneSolid(other, target) || !isSolid(*other.m_shape->m_shape) ||
            !pointShapeDistance(*other.m_shape, foot, scope.m_advantage, d) || !(d.m_gap <= scope.m_advantage))
            continue;
        if (dot(d.m_normal, normal) < -kCarrierCosine) return Beside::innerFace;
        beside = Beside::surface;
    }
    return beside;
}

// The direction from which a point of a feature came: the mean of the normals that held its corners in the last step,
// or of a vertex, into the body.
Vec3 InnerFaces::heldAt(const SearchScope& scope, const Triangle& nodes, const FeatureWeights& weights) const
{
    const Vec3 held = interpolated(m_heldNormal, nodes, weights);
    if (norm(held) > 0) return unit(held);
    return nodes[1] == nodes[0] ? inwardAt(scope, nodes[0]) : Vec3();
}

}  // namespace bullet_fem
