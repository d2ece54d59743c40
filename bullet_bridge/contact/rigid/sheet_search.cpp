// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/sheet_search.h"

#include <algorithm>
#include <cmath>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletCollision/CollisionShapes/btCollisionShape.h"

namespace bullet_fem
{
namespace
{

constexpr int kRounds = 3;        // sweeps over the faces that bound a node's path: enforcing one may violate another
constexpr double kFarther = 1.5;  // largest displacement of a node in contact, over its free one (Drum)
constexpr double kAside = 0.25;   // largest part of it that contacts turn towards a face (Drum)

// Largest component of a vector along the unit vectors within a cone, given by its axis (unit) and the cosine of its
// half angle.
double alongCone(const Vec3& way, const Vec3& axis, double cosine)
{
    const double along = dot(way, axis), across = norm(way - along * axis);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    if (along > 0 && across * cosine <= along * sine) return norm(way);
    return std::max(0.0, along * cosine + across * sine);
}

Vec3 normalOf(const std::vector<Vec3>& x, const Triangle& t)
{
    return unit(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
}

// Displacement of a node in free motion relative to the object [m].
Vec3 wayOf(const FemSoftBody& fem, const ContactTarget& target, int node)
{
    return target.m_step * (fem.surfaceVelocity()[node] - target.m_motion->velocityAt(fem.surfacePosition()[node]));
}

// True if carriers turn the path of a node, so that it differs from the free path: it may meet other triangles.
bool isTurned(const SearchScope& scope, const ContactTarget& target, const CarriedMotion& carried, int node, Vec3& way)
{
    if (!carried.isCarried(node)) return false;
    const FemSoftBody& fem = scope.fem();
    const Vec3 carriedAlong = target.m_step * target.m_motion->velocityAt(fem.surfacePosition()[node]);
    way = carried.allowed(node, target.m_step * fem.surfaceVelocity()[node]) - carriedAlong;
    return norm(way) > scope.m_band;
}

bool isNegligible(const SearchScope& scope, const Vec3& way)
{
    return norm(way) <= kNegligibleLength * scope.m_edge;
}

// The way along the contacts of a list from `first` on.
Vec3 boundedWay(Vec3 way, std::size_t first, const ContactList& list)
{
    for (int round = 0; round < kRounds; ++round)
        for (std::size_t k = first; k < list.size(); ++k)
        {
            const ContactPoint& contact = list.points()[k];
            const double into = -dot(contact.m_normal, way) - std::max(contact.m_gap, 0.0);
            if (into > 0) way += into * contact.m_normal;
        }
    return way;
}

double thicknessOf(const FemSoftBody& fem, const ContactTarget& target)
{
    return target.m_shape->m_shape->getMargin() + fem.m_settings.m_contactOffset;
}

}  // namespace

void SheetSearch::begin()
{
    m_sides.clear();
    m_measured = false;
}

void SheetSearch::findNear(SearchScope& scope, ContactTarget& target, const std::vector<Vec3>& heldNormal,
                           ContactList& near)
{
    target.m_firstSide = m_sides.size();
    if (collect(scope, target))
    {
        measureSurface(scope.fem());
        const Sheets sheets = {scope, target, thicknessOf(scope.fem(), target)};
        findOnNodes(sheets, heldNormal, near);
        findOnTriangles(sheets, near);
        findOnEdges(sheets, near);
    }
    target.m_endSide = m_sides.size();
}

// Collects triangles near the surface in m_soup; false if there are none.
bool SheetSearch::collect(SearchScope& scope, const ContactTarget& target)
{
    const double reach = target.m_reach + target.m_shape->m_shape->getMargin() + scope.fem().m_settings.m_contactOffset;
    const Vec3 box = {reach, reach, reach};
    if (!scope.m_culling.meets({target.m_shape->m_boundsMin, target.m_shape->m_boundsMax, reach})) return false;
    m_soup.collect(*target.m_shape, scope.m_culling.low() - box, scope.m_culling.high() + box);
    return !m_soup.triangles().empty();
}

// Computes the normals of the surface's nodes, weighted by the triangles' angles, and of its edges, once a step.
void SheetSearch::measureSurface(const FemSoftBody& fem)
{
    if (m_measured) return;
    m_measured = true;
    const std::vector<Vec3>& x = fem.surfacePosition();
    const std::vector<Triangle>& triangles = fem.m_surface.topology().triangles();
    m_outward.assign(x.size(), Vec3());
    m_edgeOutward.assign(fem.m_surface.topology().edgeCount(), Vec3());
    for (std::size_t k = 0; k < triangles.size(); ++k)
    {
        const Triangle& t = triangles[k];
        const Vec3 n = normalOf(x, t);
        for (int a = 0; a < 3; ++a)
        {
            const Vec3 &corner = x[t[a]], next = x[t[(a + 1) % 3]] - corner, last = x[t[(a + 2) % 3]] - corner;
            m_outward[t[a]] += angleBetween(next, last) * n;
            m_edgeOutward[fem.m_surface.topology().edgesOf(k)[a]] += n;
        }
    }
    for (int i : fem.m_surface.topology().vertices()) m_outward[i] = unit(m_outward[i]);
}

// A point on the right side of the sheets: the remembered one if the leaf was near in the last step. A node that has
// moved farther since than a step permits was placed anew by the program, and has no history.
// An exposed inner node was on the side of the surface.
Vec3 SheetSearch::safePosition(const Sheets& sheets, int node, const Vec3& position) const
{
    const ContactTarget& target = sheets.m_target;
    const SheetSide key = {broadphaseId(*target.m_object), target.m_leaf, node, Vec3(), Vec3()};
    const std::vector<SheetSide>& known = sheets.m_scope.fem().m_memory.m_sheetSides;
    const auto side = std::lower_bound(known.begin(), known.end(), key);
    if (side != known.end() && !(key < *side))
    {
        const Vec3 way = position - target.m_shape->m_pose.toWorld(side->m_position);
        if (mayHaveGone(sheets.m_scope, target, way)) return target.m_shape->m_pose.toWorld(side->m_safe);
    }
    if (sheets.m_scope.fem().m_surface.topology().trianglesAt(node).size() == 0) return sheets.m_scope.m_middle;
    return position - sheets.m_scope.m_band * m_outward[node];
}

// The node's position on the right side of the sheets, approached from above the surface that carried it: a node may be
// a little below it, where it slides past flush walls or came over a rim.
Vec3 SheetSearch::rightSideOf(const Sheets& sheets, int node, const Vec3& position, const Vec3& heldNormal) const
{
    return onRightSide(m_soup, safePosition(sheets, node, position) + sheets.m_scope.m_band * heldNormal, position);
}

void SheetSearch::findOnNodes(const Sheets& sheets, const std::vector<Vec3>& heldNormal, ContactList& list)
{
    const ContactTarget& target = sheets.m_target;
    const FemSoftBody& fem = sheets.m_scope.fem();
    const int objectId = broadphaseId(*target.m_object);
    for (int i : sheets.m_scope.vertices())
    {
        const Vec3& x = fem.surfacePosition()[i];
        const SheetProbe probe = {x, rightSideOf(sheets, i, x, heldNormal[i]), wayOf(fem, target, i),
                                  sheets.m_scope.m_band, sheets.m_thickness};
        findPointContacts(m_soup, probe, m_touches);
        considerContacts(sheets, i, {i, i, i}, list);
        const Pose& pose = target.m_shape->m_pose;
        m_sides.push_back(
            {objectId, target.m_leaf, i, pose.toLocal(probe.m_position), pose.toLocal(probe.m_rightSide)});
    }
}

void SheetSearch::findOnPaths(SearchScope& scope, const ContactTarget& target, const ContactList& near,
                              const FlushFilter& filter, ContactList& list)
{
    const FemSoftBody& fem = scope.fem();
    const CarriedMotion& carried = filter.carried();
    const Sheets sheets = {scope, target, thicknessOf(fem, target)};
    const auto keepNear = [&](std::size_t k)
    {
        if (!filter.isFlush(k)) list.append(near, k);
    };
    std::size_t k = target.m_first, side = target.m_firstSide;
    bool isCollected = false;
    for (int i : sheets.m_scope.vertices())
    {
        if (side == target.m_endSide) break;
        Vec3 way;
        const bool turned = isTurned(scope, target, carried, i, way);
        const std::size_t first = list.size(), firstNear = k;
        for (; k < target.m_end && near.origins()[k].m_feature == i; ++k)
            if (!turned || near.points()[k].m_gap <= scope.m_band) keepNear(k);
        const Vec3 rightSide = target.m_shape->m_pose.toWorld(m_sides[side++].m_safe);
        // All contacts of the node were dropped as flush with each other: it meets the face below the end of its path.
        const bool dropped = k > firstNear && list.size() == first && !carried.isCarried(i);
        if (!turned) way = wayOf(fem, target, i);
        if (!turned && !dropped && (list.size() == first || isNegligible(scope, way))) continue;
        if (!isCollected) collect(scope, target);
        isCollected = true;
        const BoundedNode node = {i, way, rightSide, carried.liftOf(i), first};
        if (turned || dropped) considerPath(sheets, node, list);
        considerEnds(sheets, node, list);
    }
    for (; k < target.m_end; ++k) keepNear(k);
}

SheetProbe SheetSearch::liftedProbe(const Sheets& sheets, const BoundedNode& node, const Vec3& way) const
{
    return {sheets.m_scope.fem().surfacePosition()[node.m_node] + node.m_lift,
            onRightSide(m_soup, node.m_rightSide, node.m_rightSide + node.m_lift), way, sheets.m_scope.m_band,
            sheets.m_thickness};
}

// Takes the lift back from the gaps that were found with it.
void SheetSearch::lower(const Vec3& lift)
{
    for (SheetContact& touch : m_touches) touch.m_surface.m_gap -= dot(touch.m_surface.m_normal, lift);
}

void SheetSearch::considerPath(const Sheets& sheets, const BoundedNode& node, ContactList& list)
{
    findPointContacts(m_soup, liftedProbe(sheets, node, node.m_way), m_touches);
    lower(node.m_lift);
    const auto isKnown = [&](const SheetContact& touch) { return touch.m_surface.m_gap <= sheets.m_scope.m_band; };
    m_touches.erase(std::remove_if(m_touches.begin(), m_touches.end(), isKnown), m_touches.end());
    considerContacts(sheets, node.m_node, {node.m_node, node.m_node, node.m_node}, list);
}

// A node goes along the faces that it meets, past the concave edges between them. Contacts of others may carry it
// farther than it would go freely, or aside: faces that it may come close to bound it, too.
void SheetSearch::considerEnds(const Sheets& sheets, const BoundedNode& node, ContactList& list)
{
    const Triangle corners = {node.m_node, node.m_node, node.m_node};
    for (double length : {1.0, kFarther})
    {
        const Vec3 way = boundedWay(length * node.m_way, node.m_first, list);
        if (isNegligible(sheets.m_scope, way)) return;
        SheetProbe probe = liftedProbe(sheets, node, way);
        probe.m_band += norm(node.m_lift) + kAside * norm(way);
        findContactsAtEnd(m_soup, probe, kNegligibleLength * sheets.m_scope.m_edge, m_touches);
        lower(node.m_lift);
        for (const SheetContact& touch : m_touches)
        {
            const Vec3& normal = touch.m_surface.m_normal;
            const bool isKnown =
                std::any_of(list.points().begin() + static_cast<std::ptrdiff_t>(node.m_first), list.points().end(),
                            [&](const ContactPoint& known) { return dot(known.m_normal, normal) > kParallelNormals; });
            if (isKnown || !faces(sheets.m_scope.fem(), corners, normal)) continue;
            if (list.keep(sheets.m_scope, sheets.m_target, node.m_node, corners, touch.m_surface))
                noteTriangle(touch, list);
        }
    }
}

// Writes the triangle of the last contact.
void SheetSearch::noteTriangle(const SheetContact& touch, ContactList& list) const
{
    list.origins().back().m_part = m_soup.triangles()[touch.m_triangle].m_part;
    list.origins().back().m_triangle = m_soup.triangles()[touch.m_triangle].m_index;
}

void SheetSearch::findOnTriangles(const Sheets& sheets, ContactList& list)
{
    const SoftSurface& surface = sheets.m_scope.fem().m_surface;
    const std::vector<Vec3>& x = sheets.m_scope.fem().surfacePosition();
    const int firstFeature = surface.topology().vertexCount();
    for (std::size_t k = 0; k < surface.topology().triangles().size(); ++k)
    {
        const Triangle& t = surface.topology().triangles()[k];
        SheetFeature feature;
        feature.m_outward = normalOf(x, t);
        double closing = 0;
        for (int a = 0; a < 3; ++a)
        {
            feature.m_corners[a] = x[t[a]];
            closing = std::max(closing, dot(wayOf(sheets.m_scope.fem(), sheets.m_target, t[a]), feature.m_outward));
        }
        feature.m_reach = sheets.m_scope.m_band + closing;
        feature.m_depth = sheets.m_scope.depthOn(static_cast<int>(k));
        feature.m_thickness = sheets.m_thickness;
        findCornerContacts(m_soup, feature, m_touches);
        considerContacts(sheets, firstFeature + static_cast<int>(k), t, list);
    }
}

void SheetSearch::findOnEdges(const Sheets& sheets, ContactList& list)
{
    const SoftSurface& surface = sheets.m_scope.fem().m_surface;
    const std::vector<Vec3>& x = sheets.m_scope.fem().surfacePosition();
    const int firstFeature = surface.topology().vertexCount() + surface.topology().triangleCount();
    const std::vector<std::array<int, 2>>& edges = surface.topology().edges();
    for (std::size_t k = 0; k < edges.size(); ++k)
    {
        const auto [a, b] = edges[k];
        SheetFeature feature;
        feature.m_corners[0] = x[a];
        feature.m_corners[1] = feature.m_corners[2] = x[b];
        feature.m_outward = unit(m_edgeOutward[k]);
        feature.m_halfAngle = 0.5 * norm(m_edgeOutward[k]);
        const double cosine = widestNormal(feature);
        feature.m_reach =
            sheets.m_scope.m_band +
            std::max(alongCone(wayOf(sheets.m_scope.fem(), sheets.m_target, a), feature.m_outward, cosine),
                     alongCone(wayOf(sheets.m_scope.fem(), sheets.m_target, b), feature.m_outward, cosine));
        const auto [first, second] = surface.topology().trianglesOf(static_cast<int>(k));
        feature.m_depth = std::min(sheets.m_scope.depthOn(first), sheets.m_scope.depthOn(second));
        feature.m_thickness = sheets.m_thickness;
        findEdgeContacts(m_soup, feature, m_touches);
        considerContacts(sheets, firstFeature + static_cast<int>(k), {a, b, a}, list);
    }
}

void SheetSearch::considerContacts(const Sheets& sheets, int feature, const Triangle& nodes, ContactList& list)
{
    for (const SheetContact& touch : m_touches)
    {
        const std::size_t before = list.size();
        list.consider(sheets.m_scope, sheets.m_target, feature, nodes, touch.m_surface);
        if (list.size() > before) noteTriangle(touch, list);
    }
}

}  // namespace bullet_fem
