// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <limits>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "bullet_bridge/contact/rigid/contact_finder.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"

namespace bullet_fem
{
namespace
{

constexpr double kNotNear = std::numeric_limits<double>::infinity();
constexpr double kGradientSlack = 1e-3;  // tolerance of gaps bounded by gradients, over the mean edge
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
bool weightsOf(const Corners& t, const Vec3& p, std::array<double, 3>& weights)
{
    const Vec3 edge = t[1] - t[0];
    const double square = dot(edge, edge);
    if (norm(t[2] - t[0]) > 0) return projectOnPlane(t, p, weights);
    if (!(square > 0)) return false;
    const double along = dot(p - t[0], edge) / square;
    weights = {1 - along, along, 0};
    return true;
}

}  // namespace

// Finds the contacts of a target as the step begins, and the candidates within the step.
void ContactFinder::findNear(FemSoftBody& fem, Target& target)
{
    target.m_first = m_contacts.size();
    const btCollisionShape& shape = *target.m_shape->m_shape;
    if (isSheet(shape))
    {
        target.m_kind = TargetKind::sheets;
        target.m_firstSide = m_sheetSides.size();
        findOnSheets(fem, target);
        target.m_endSide = m_sheetSides.size();
    }
    else if (isSolid(shape) && isFastTarget(fem, target))
    {
        target.m_kind = TargetKind::fast;
        findTouchingNodes(fem, target);
    }
    else if (m_culling.meets({target.m_shape->m_boundsMin, target.m_shape->m_boundsMax, target.m_reach}))
    {
        findOnNodes(fem, target);
        if (isSolid(shape))
        {
            findOnEdges(fem, target);
            findOnTriangles(fem, target);
        }
    }
    target.m_end = m_contacts.size();
}

void ContactFinder::findOnNodes(FemSoftBody& fem, const Target& target)
{
    const double reach = target.m_reach;
    const double farthest = reach + m_culling.longestEdge();  // gaps up to this are noted for culling
    for (int i : fem.m_surface.nodes())
    {
        const Vec3& x = fem.surfacePosition()[i];
        fem.m_nodeGap[i] = kNotNear;
        SurfaceDistance d;
        if (!m_culling.noteVertex(i, x, x))
        {
            m_culling.noteNoGap(i);
            continue;
        }
        const bool isKnown = pointShapeDistance(*target.m_shape, x, farthest, d);
        m_culling.noteGap(i, isKnown ? d.m_gap : kNotNear, d.m_normal);
        if (!isKnown || d.m_gap > reach) continue;
        fem.m_nodeGap[i] = d.m_gap -= fem.m_contactOffset;
        fem.m_nodeNormal[i] = d.m_normal;
        consider(fem, target, i, {i, i, i}, d);
    }
}

// True if both nodes lie over one flat face of the shape: their normals agree, so their contacts suffice.
bool ContactFinder::overOneFace(const FemSoftBody& fem, int a, int b) const
{
    return fem.m_nodeGap[a] < kNotNear && fem.m_nodeGap[b] < kNotNear &&
           dot(fem.m_nodeNormal[a], fem.m_nodeNormal[b]) > 1 - 1e-9;
}

// True if no point of the edge or triangle is within reach.
bool ContactFinder::isFar(const Target& target, const Triangle& nodes) const
{
    return m_culling.leastGap(nodes) > target.m_reach + kGradientSlack * m_edge;
}

void ContactFinder::findOnEdges(FemSoftBody& fem, const Target& target)
{
    const int edgeCount = static_cast<int>(fem.m_surface.features().m_edges.size());
    const int firstFeature = fem.m_surface.vertexCount();
    for (int k = 0; k < edgeCount; ++k)
    {
        const auto [a, b] = fem.m_surface.features().m_edges[k];
        fem.m_edgeGap[k] = kNotNear;
        const Triangle edge = {a, b, a};
        if (m_culling.isOutside(edge) || overOneFace(fem, a, b) || isFar(target, edge)) continue;
        SurfaceDistance d;
        fem.m_edgeGap[k] = gapAt(fem, target, edge, {0.5, 0.5, 0}, d);
        if (fem.m_edgeGap[k] < kNotNear) consider(fem, target, firstFeature + 2 * k, edge, d);
        const double nearest = std::min({fem.m_edgeGap[k], fem.m_nodeGap[a], fem.m_nodeGap[b]});
        fem.m_edgeGap[k] = considerNearest(fem, target, firstFeature + 2 * k + 1, edge, nearest);
    }
}

void ContactFinder::findOnTriangles(FemSoftBody& fem, const Target& target)
{
    const int triangleCount = static_cast<int>(fem.m_surface.triangles().size());
    const int firstFeature =
        fem.m_surface.vertexCount() + 2 * static_cast<int>(fem.m_surface.features().m_edges.size());
    const bool isSmall = norm(target.m_shape->m_boundsMax - target.m_shape->m_boundsMin) < kSmallShape * m_edge;
    m_lainOn.clear();
    for (int k = 0; k < triangleCount; ++k)
    {
        const Triangle& t = fem.m_surface.triangles()[k];
        if (m_culling.isOutside(t) || (overOneFace(fem, t[0], t[1]) && overOneFace(fem, t[0], t[2]))) continue;
        if (isFar(target, t)) continue;
        SurfaceDistance d;
        double nearest = gapAt(fem, target, t, {1.0 / 3, 1.0 / 3, 1.0 / 3}, d);
        if (nearest < kNotNear) consider(fem, target, firstFeature + 2 * k, t, d);
        for (int a = 0; a < 3; ++a)
            nearest =
                std::min({nearest, fem.m_nodeGap[t[a]], fem.m_edgeGap[fem.m_surface.features().m_triangleEdges[k][a]]});
        if (isSmall && isUnderCorner(fem, target, t))
            m_lainOn.push_back(k);
        else
            considerNearest(fem, target, firstFeature + 2 * k + 1, t, nearest);
    }
    findOnCorners(fem, target);
}

// Tests the point of an edge (first and last node equal) or triangle that is nearest to the shape. It becomes a contact
// if it is closer than `nearest`, the gap of the known fixed points. Within the contact band it must be closer by a
// margin, because it wanders there; the margin is smaller if the point pushed in the last step, otherwise a resting
// object would sink by the margin and be pushed out again. Returns the smaller of the two gaps.
double ContactFinder::considerNearest(FemSoftBody& fem, const Target& target, int feature, const Triangle& nodes,
                                      double nearest)
{
    const std::vector<Vec3>& x = fem.surfacePosition();
    if (m_culling.leastGap(nodes) - fem.m_contactOffset >= nearest - kGapRounding * m_edge) return nearest;
    SurfaceDistance d;
    if (!triangleShapeDistance(*target.m_shape, {x[nodes[0]], x[nodes[1]], x[nodes[2]]}, target.m_reach, d))
        return nearest;
    const double gap = d.m_gap -= fem.m_contactOffset;
    const ContactPoint* const last = gap < m_band ? pushing(fem, originOf(target, feature)) : nullptr;
    const double advantage = gap >= m_band ? kGapRounding * m_edge : last ? kHeldAdvantage * m_advantage : m_advantage;
    if (!(gap < nearest - advantage)) return std::min(gap, nearest);
    const std::size_t count = m_contacts.size();
    consider(fem, target, feature, nodes, d);
    if (last && m_contacts.size() > count) holdBack(fem, nodes, *last, d.m_barycentric, target.m_step);
    return gap;
}

// Damps the node weights of a nearest point. The nearest point to a round shape moves far while its triangle rotates
// little; the load moves with it to other nodes and rotates the triangle back, so both would oscillate from step to
// step. Only the node weights lag: the impulse acts at the true nearest point, since a lagging one would drive a ball
// on.
void ContactFinder::holdBack(const FemSoftBody& fem, const Triangle& nodes, const ContactPoint& last,
                             const Weights& nearest, double step)
{
    const std::vector<Vec3>& x = fem.surfacePosition();
    if (step * norm(last.m_soft.of(fem.m_body.m_state.m_v)) > kSlowestWander * m_edge) return;  // an impact
    Weights weights;
    if (!weightsOf({x[nodes[0]], x[nodes[1]], x[nodes[2]]}, last.m_soft.of(fem.m_body.m_state.m_x), weights)) return;
    for (int k = 0; k < 3; ++k) weights[k] += kFollowedShare * (nearest[k] - weights[k]);
    if (!(std::min({weights[0], weights[1], weights[2]}) >= 0)) return;  // a skin's point may have left it
    if (norm(interpolated(x, nodes, weights) - interpolated(x, nodes, nearest)) > kFarthestBehind * m_edge) return;
    m_contacts.back().m_soft = fem.pointOn(m_bodyIndex, nodes, weights);
}

// Gap at a point of the surface; infinite if it is out of reach.
double ContactFinder::gapAt(const FemSoftBody& fem, const Target& target, const Triangle& nodes, const Weights& weights,
                            SurfaceDistance& d) const
{
    const Vec3 point = interpolated(fem.surfacePosition(), nodes, weights);
    if (!overlaps(point, *target.m_shape, target.m_reach) ||
        !pointShapeDistance(*target.m_shape, point, target.m_reach, d))
        return kNotNear;
    d.m_barycentric = weights;
    return d.m_gap -= fem.m_contactOffset;
}

}  // namespace bullet_fem
