// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/node_search.h"

#include <algorithm>
#include <limits>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletCollision/CollisionShapes/btPolyhedralConvexShape.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_bridge/geometry/tolerances.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kNotNear = std::numeric_limits<double>::infinity();
constexpr double kHeldAdvantage = 0.1;   // share of the advantage that a nearest point needs if it pushed in the last
                                         // step
constexpr double kSlowestWander = 0.02;  // largest displacement of a steady nearest point in a step, over the mean edge
constexpr double kFollowedShare = 0.1;   // share of the nearest point's displacement that the node weights follow
constexpr double kFarthestBehind = 0.1;  // largest lag of the node weights, over the mean edge
constexpr double kSmallShape = 2;        // size of a small shape, which a single triangle may carry, over the mean edge
constexpr double kGapRounding = 1e-9;    // rounding of gaps, over the mean edge

bool overlaps(const Vec3& point, const ShapeLeaf& shape, double reach)
{
    for (int c = 0; c < 3; ++c)
        if (point[c] < shape.m_boundsMin[c] - reach || point[c] > shape.m_boundsMax[c] + reach) return false;
    return true;
}

// Barycentric coordinates of a point near a triangle, or near an edge, whose first and last corners are equal.
bool weightsOf(const Corners& t, const Vec3& p, FeatureWeights& weights)
{
    const Vec3 edge = t[1] - t[0];
    const double square = dot(edge, edge);
    if (norm(t[2] - t[0]) > 0) return projectOnPlane(t, p, weights);
    if (!(square > 0)) return false;
    const double along = dot(p - t[0], edge) / square;
    weights = {1 - along, along, 0};
    return true;
}

// Distance between a polyhedron's vertices and its surface: the vertices of boxes include the margin, others do not.
double marginOf(const btCollisionShape& shape)
{
    return shape.getShapeType() == BOX_SHAPE_PROXYTYPE ? 0 : double(shape.getMargin());
}

// Calls use(corner, distance) for the corners of a polyhedral shape that lie over a triangle and within reach.
template <class Use>
void forEachCornerOver(const SearchScope& scope, const ContactTarget& target, int triangle, const Use& use)
{
    const FemSoftBody& fem = scope.fem();
    const Triangle& t = fem.m_surface.topology().triangles()[triangle];
    const double depth = scope.depthOn(triangle);
    const btCollisionShape& shape = *target.m_shape->m_shape;
    if (!shape.isPolyhedral()) return;
    const auto& polyhedron = static_cast<const btPolyhedralConvexShape&>(shape);
    if (polyhedron.getNumVertices() > kMaxCorners) return;
    const std::vector<Vec3>& x = fem.surfacePosition();
    const Corners corners = {x[t[0]], x[t[1]], x[t[2]]};
    const Vec3 normal = normalOf(corners);
    const double distance = marginOf(shape) + fem.m_settings.m_contactOffset;
    for (int k = 0; k < polyhedron.getNumVertices(); ++k)
    {
        btVector3 vertex;
        polyhedron.getVertex(k, vertex);
        const Vec3 corner = target.m_shape->m_pose.toWorld(vec3(vertex));
        SurfaceDistance d = {dot(normal, corner - corners[0]) - distance, -normal, {}};
        if (!(d.m_gap <= target.m_reach && d.m_gap > -depth)) continue;
        if (!projectOnPlane(corners, corner, d.m_barycentric)) return;
        if (std::min({d.m_barycentric[0], d.m_barycentric[1], d.m_barycentric[2]}) >= 0) use(k, d);
    }
}

bool isUnderCorner(const SearchScope& scope, const ContactTarget& target, int triangle)
{
    bool isUnder = false;
    forEachCornerOver(scope, target, triangle, [&](int, const SurfaceDistance&) { isUnder = true; });
    return isUnder;
}

// True if no point of the edge or triangle is within reach.
bool isFar(const SearchScope& scope, const ContactTarget& target, const Triangle& nodes)
{
    return scope.m_culling.minGap(nodes) > target.m_reach + kNegligibleLength * scope.m_edge;
}

// Gap at a point of the surface; infinite if it is out of reach.
double gapAt(const SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target, int feature,
             const Triangle& nodes, const FeatureWeights& weights, SurfaceDistance& d)
{
    const FemSoftBody& fem = scope.fem();
    const Vec3 point = interpolated(fem.surfacePosition(), nodes, weights);
    if (!overlaps(point, *target.m_shape, target.m_reach) ||
        !pointShapeDistance(*target.m_shape, point, target.m_reach, d))
        return kNotNear;
    d.m_barycentric = weights;
    d.m_gap -= fem.m_settings.m_contactOffset;
    innerFaces.turn(scope, target, feature, nodes, d);
    return d.m_gap;
}

// Damps the node weights of a nearest point. The nearest point to a round shape moves far while its triangle rotates
// little; the load moves with it to other nodes and rotates the triangle back, so both would oscillate from step to
// step. Only the node weights lag: the impulse acts at the true nearest point, since a lagging one would drive a ball
// on.
void holdBack(const SearchScope& scope, const Triangle& nodes, const ContactPoint& last, const FeatureWeights& nearest,
              double step, ContactPoint& contact)
{
    const FemSoftBody& fem = scope.fem();
    const std::vector<Vec3>& x = fem.surfacePosition();
    if (step * norm(last.m_soft.of(fem.m_body.m_state.m_v)) > kSlowestWander * scope.m_edge) return;  // an impact
    FeatureWeights weights;
    if (!weightsOf({x[nodes[0]], x[nodes[1]], x[nodes[2]]}, last.m_soft.of(fem.m_body.m_state.m_x), weights)) return;
    for (int k = 0; k < 3; ++k) weights[k] += kFollowedShare * (nearest[k] - weights[k]);
    if (!(std::min({weights[0], weights[1], weights[2]}) >= 0)) return;  // a skin's point may have left it
    if (norm(interpolated(x, nodes, weights) - interpolated(x, nodes, nearest)) > kFarthestBehind * scope.m_edge)
        return;
    contact.m_soft = fem.pointOn(scope.m_bodyIndex, nodes, weights);
}

}  // namespace

void NodeSearch::find(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target, ContactList& list)
{
    findOnNodes(scope, innerFaces, target, list);
    if (!isSolid(*target.m_shape->m_shape)) return;
    findOnEdges(scope, innerFaces, target, list);
    findOnTriangles(scope, innerFaces, target, list);
}

void NodeSearch::findOnNodes(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target,
                             ContactList& list)
{
    FemSoftBody& fem = scope.fem();
    const double reach = target.m_reach;
    const double farthest = reach + scope.m_culling.longestEdge();  // gaps up to this are noted for culling
    for (int i : scope.vertices())
    {
        const Vec3& x = fem.surfacePosition()[i];
        fem.m_search.m_nodeGap[i] = kNotNear;
        SurfaceDistance d;
        if (!scope.m_culling.noteVertex(i, x, x))
        {
            scope.m_culling.noteNoGap(i);
            continue;
        }
        const bool isKnown = pointShapeDistance(*target.m_shape, x, farthest, d);
        scope.m_culling.noteGap(i, isKnown ? d.m_gap : kNotNear, d.m_normal);
        if (!isKnown || d.m_gap > reach) continue;
        d.m_gap -= fem.m_settings.m_contactOffset;
        innerFaces.turn(scope, target, i, {i, i, i}, d);
        fem.m_search.m_nodeGap[i] = d.m_gap;
        fem.m_search.m_nodeNormal[i] = d.m_normal;
        list.consider(scope, target, i, {i, i, i}, d);
    }
}

void NodeSearch::findOnEdges(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target,
                             ContactList& list)
{
    FemSoftBody& fem = scope.fem();
    const int edgeCount = fem.m_surface.topology().edgeCount();
    const int firstFeature = fem.m_surface.topology().vertexCount();
    for (int k = 0; k < edgeCount; ++k)
    {
        const auto [a, b] = fem.m_surface.topology().edges()[k];
        fem.m_search.m_edgeGap[k] = kNotNear;
        const Triangle edge = {a, b, a};
        if (scope.m_culling.isOutside(edge) || areOverOneFace(fem, a, b) || isFar(scope, target, edge)) continue;
        SurfaceDistance d;
        fem.m_search.m_edgeGap[k] = gapAt(scope, innerFaces, target, firstFeature + 2 * k, edge, {0.5, 0.5, 0}, d);
        if (fem.m_search.m_edgeGap[k] < kNotNear) list.consider(scope, target, firstFeature + 2 * k, edge, d);
        const double nearest =
            std::min({fem.m_search.m_edgeGap[k], fem.m_search.m_nodeGap[a], fem.m_search.m_nodeGap[b]});
        fem.m_search.m_edgeGap[k] =
            considerNearest(scope, innerFaces, target, firstFeature + 2 * k + 1, edge, nearest, list);
    }
}

void NodeSearch::findOnTriangles(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target,
                                 ContactList& list)
{
    FemSoftBody& fem = scope.fem();
    const int triangleCount = fem.m_surface.topology().triangleCount();
    const int firstFeature = fem.m_surface.topology().vertexCount() + 2 * fem.m_surface.topology().edgeCount();
    const bool isSmall = norm(target.m_shape->m_boundsMax - target.m_shape->m_boundsMin) < kSmallShape * scope.m_edge;
    m_underCorners.clear();
    for (int k = 0; k < triangleCount; ++k)
    {
        const Triangle& t = fem.m_surface.topology().triangles()[k];
        if (scope.m_culling.isOutside(t) || (areOverOneFace(fem, t[0], t[1]) && areOverOneFace(fem, t[0], t[2])))
            continue;
        if (isFar(scope, target, t)) continue;
        SurfaceDistance d;
        double nearest = gapAt(scope, innerFaces, target, firstFeature + 2 * k, t, {1.0 / 3, 1.0 / 3, 1.0 / 3}, d);
        if (nearest < kNotNear) list.consider(scope, target, firstFeature + 2 * k, t, d);
        for (int a = 0; a < 3; ++a)
            nearest = std::min({nearest, fem.m_search.m_nodeGap[t[a]],
                                fem.m_search.m_edgeGap[fem.m_surface.topology().edgesOf(k)[a]]});
        if (isSmall && isUnderCorner(scope, target, k))
            m_underCorners.push_back(k);
        else
            considerNearest(scope, innerFaces, target, firstFeature + 2 * k + 1, t, nearest, list);
    }
    findOnCorners(scope, target, list);
}

// Contacts at the corners of a small shape whose face lies between all fixed points of the surface. A single nearest
// point would jump between the corners and tip the shape over.
void NodeSearch::findOnCorners(const SearchScope& scope, const ContactTarget& target, ContactList& list)
{
    const FemSoftBody& fem = scope.fem();
    const int firstFeature = firstCornerFeature(fem);
    for (int triangle : m_underCorners)
    {
        const Triangle& t = fem.m_surface.topology().triangles()[triangle];
        forEachCornerOver(scope, target, triangle,
                          [&](int corner, const SurfaceDistance& d)
                          { list.consider(scope, target, firstFeature + kMaxCorners * triangle + corner, t, d); });
    }
}

// Tests the point of an edge (first and last node equal) or triangle that is nearest to the shape. It becomes a contact
// if it is closer than `nearest`, the gap of the known fixed points. Within the contact band it must be closer by a
// margin, because it wanders there; the margin is smaller if the point pushed in the last step, otherwise a resting
// object would sink by the margin and be pushed out again. Returns the smaller of the two gaps.
double NodeSearch::considerNearest(const SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target,
                                   int feature, const Triangle& nodes, double nearest, ContactList& list)
{
    const FemSoftBody& fem = scope.fem();
    const std::vector<Vec3>& x = fem.surfacePosition();
    if (scope.m_culling.minGap(nodes) - fem.m_settings.m_contactOffset >= nearest - kGapRounding * scope.m_edge)
        return nearest;
    SurfaceDistance d;
    if (!triangleShapeDistance(*target.m_shape, {x[nodes[0]], x[nodes[1]], x[nodes[2]]}, target.m_reach, d))
        return nearest;
    d.m_gap -= fem.m_settings.m_contactOffset;
    innerFaces.turn(scope, target, feature, nodes, d);
    const double gap = d.m_gap;
    const ContactPoint* const last = gap < scope.m_band ? pushingContact(fem, originOf(target, feature)) : nullptr;
    const double advantage = gap >= scope.m_band ? kGapRounding * scope.m_edge
                             : last              ? kHeldAdvantage * scope.m_advantage
                                                 : scope.m_advantage;
    if (!(gap < nearest - advantage)) return std::min(gap, nearest);
    const std::size_t count = list.size();
    list.consider(scope, target, feature, nodes, d);
    if (last && list.size() > count)
        holdBack(scope, nodes, *last, d.m_barycentric, target.m_step, list.points().back());
    return gap;
}

}  // namespace bullet_fem
