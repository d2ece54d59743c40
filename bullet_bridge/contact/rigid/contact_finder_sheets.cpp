// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cmath>

#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "bullet_bridge/contact/rigid/contact_finder.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

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

}  // namespace

void ContactFinder::findOnSheets(FemSoftBody& fem, const Target& target)
{
    if (!collectSheets(fem, target)) return;
    measureSurface(fem);
    const SheetSearch search = {fem, target, target.m_shape->m_shape->getMargin() + fem.m_contactOffset};
    findOnSheetNodes(search);
    findOnSheetTriangles(search);
    findOnSheetEdges(search);
}

// Collects triangles near the surface in m_soup; false if there are none.
bool ContactFinder::collectSheets(const FemSoftBody& fem, const Target& target)
{
    const double reach = target.m_reach + target.m_shape->m_shape->getMargin() + fem.m_contactOffset;
    const Vec3 box = {reach, reach, reach};
    if (!m_culling.meets({target.m_shape->m_boundsMin, target.m_shape->m_boundsMax, reach})) return false;
    m_soup.collect(*target.m_shape, m_culling.low() - box, m_culling.high() + box);
    return !m_soup.triangles().empty();
}

// Computes the normals of the surface's nodes and edges, once a step.
void ContactFinder::measureSurface(const FemSoftBody& fem)
{
    if (m_measured) return;
    m_measured = true;
    const std::vector<Vec3>& x = fem.surfacePosition();
    const std::vector<Triangle>& triangles = fem.m_surface.triangles();
    m_outward.assign(x.size(), Vec3());
    m_edgeOutward.assign(fem.m_surface.features().m_edges.size(), Vec3());
    for (std::size_t k = 0; k < triangles.size(); ++k)
    {
        const Vec3 n = normalOf(x, triangles[k]);
        for (int a = 0; a < 3; ++a)
        {
            m_outward[triangles[k][a]] += n;
            m_edgeOutward[fem.m_surface.features().m_triangleEdges[k][a]] += n;
        }
    }
    for (int i : fem.m_surface.nodes()) m_outward[i] = unit(m_outward[i]);
}

// Displacement of a node in free motion relative to the object [m].
Vec3 ContactFinder::wayOf(const SheetSearch& search, int node) const
{
    const FemSoftBody& fem = search.m_fem;
    return search.m_target.m_step *
           (fem.surfaceVelocity()[node] - search.m_target.m_motion->velocityAt(fem.surfacePosition()[node]));
}

// A point on the right side of the sheets: the remembered one if the leaf was near in the last step. A node that has
// moved farther since than a step permits was placed anew by the program, and has no history.
Vec3 ContactFinder::safePosition(const SheetSearch& search, int node, const Vec3& position) const
{
    const Target& target = search.m_target;
    const SheetSide key = {broadphaseId(*target.m_object), target.m_leaf, node, Vec3(), Vec3()};
    const std::vector<SheetSide>& known = search.m_fem.m_sheetSides;
    const auto side = std::lower_bound(known.begin(), known.end(), key);
    if (side != known.end() && !(key < *side))
    {
        const Vec3 way = position - target.m_shape->m_pose.toWorld(side->m_position);
        if (norm(way) < 4 * target.m_reach + m_edge) return target.m_shape->m_pose.toWorld(side->m_safe);
    }
    return position - m_band * m_outward[node];
}

// The node's position on the right side of the sheets. A sliding node may pass flush walls a little below the surface
// that carried it, so it approaches its position from above.
Vec3 ContactFinder::rightSideOf(const SheetSearch& search, int node, const Vec3& position) const
{
    const Vec3 safe = safePosition(search, node, position);
    const Vec3 lift = m_band * m_heldNormal[node];
    return onRightSide(m_soup, norm(lift) > 0 ? onRightSide(m_soup, safe, position + lift) : safe, position);
}

void ContactFinder::findOnSheetNodes(const SheetSearch& search)
{
    const Target& target = search.m_target;
    const FemSoftBody& fem = search.m_fem;
    const int objectId = broadphaseId(*target.m_object);
    for (int i : fem.m_surface.nodes())
    {
        const Vec3& x = fem.surfacePosition()[i];
        const SheetProbe probe = {x, rightSideOf(search, i, x), wayOf(search, i), m_band, search.m_thickness};
        findPointTouches(m_soup, probe, m_touches);
        considerTouches(search, i, {i, i, i});
        const Pose& pose = target.m_shape->m_pose;
        m_sheetSides.push_back(
            {objectId, target.m_leaf, i, pose.toLocal(probe.m_position), pose.toLocal(probe.m_rightSide)});
    }
}

// True if carriers turn the path of a node, so that it differs from the free path: it may meet other triangles.
bool ContactFinder::isTurned(const SheetSearch& search, int node, Vec3& way) const
{
    if (!m_carried.isCarried(node)) return false;
    const Target& target = search.m_target;
    const Vec3 carriedAlong = target.m_step * target.m_motion->velocityAt(search.m_fem.surfacePosition()[node]);
    way = m_carried.allowed(node, target.m_step * search.m_fem.surfaceVelocity()[node]) - carriedAlong;
    return norm(way) > m_band;
}

// Contacts with sheets: those near that are not flush, and for vertices with a turned path, those on the path.
void ContactFinder::findOnSheetPaths(FemSoftBody& fem, const Target& target)
{
    const SheetSearch search = {fem, target, target.m_shape->m_shape->getMargin() + fem.m_contactOffset};
    std::size_t k = target.m_first, side = target.m_firstSide;
    bool isCollected = false;
    for (int i : fem.m_surface.nodes())
    {
        if (side == target.m_endSide) break;
        Vec3 way;
        const bool turned = isTurned(search, i, way);
        const std::size_t first = m_contacts.size(), firstNear = k;
        for (; k < target.m_end && m_nearOrigins[k].m_feature == i; ++k)
            if (!turned || m_near[k].m_gap <= m_band) keepNear(k);
        const Vec3 rightSide = target.m_shape->m_pose.toWorld(m_sheetSides[side++].m_safe);
        // All contacts of the node were dropped as flush with each other: it meets the face below the end of its path.
        const bool dropped = k > firstNear && m_contacts.size() == first && !m_carried.isCarried(i);
        if (!turned && !dropped) continue;
        if (dropped) way = wayOf(search, i);
        if (!isCollected) collectSheets(fem, target);
        isCollected = true;
        considerSheetPath(search, i, way, rightSide, first);
    }
    for (; k < target.m_end; ++k) keepNear(k);
}

// `first`: index of the node's first contact.
void ContactFinder::considerSheetPath(const SheetSearch& search, int node, const Vec3& way, const Vec3& rightSide,
                                      std::size_t first)
{
    const Vec3 lift = m_carried.liftOf(node);
    const SheetProbe probe = {search.m_fem.surfacePosition()[node] + lift,
                              onRightSide(m_soup, rightSide, rightSide + lift), way, m_band, search.m_thickness};
    const auto considerBut = [&](const auto& isKnown)
    {
        for (SheetTouch& touch : m_touches) touch.m_surface.m_gap -= dot(touch.m_surface.m_normal, lift);
        m_touches.erase(std::remove_if(m_touches.begin(), m_touches.end(), isKnown), m_touches.end());
        considerTouches(search, node, {node, node, node});
    };
    findPointTouches(m_soup, probe, m_touches);
    considerBut([this](const SheetTouch& touch) { return touch.m_surface.m_gap <= m_band; });
    findTouchesAtEnd(m_soup, probe, m_touches);
    considerBut(
        [&](const SheetTouch& touch)
        {
            return std::any_of(m_contacts.begin() + static_cast<std::ptrdiff_t>(first), m_contacts.end(),
                               [&](const ContactPoint& known)
                               { return dot(known.m_normal, touch.m_surface.m_normal) > kParallelNormals; });
        });
}

void ContactFinder::findOnSheetTriangles(const SheetSearch& search)
{
    const SoftSurface& surface = search.m_fem.m_surface;
    const std::vector<Vec3>& x = search.m_fem.surfacePosition();
    const int firstFeature = surface.vertexCount();
    for (std::size_t k = 0; k < surface.triangles().size(); ++k)
    {
        const Triangle& t = surface.triangles()[k];
        SheetFeature feature;
        feature.m_outward = normalOf(x, t);
        double closing = 0;
        for (int a = 0; a < 3; ++a)
        {
            feature.m_corners[a] = x[t[a]];
            closing = std::max(closing, dot(wayOf(search, t[a]), feature.m_outward));
        }
        feature.m_reach = m_band + closing;
        feature.m_depth = kFeatureDepth * m_edge;
        feature.m_thickness = search.m_thickness;
        findCornerTouches(m_soup, feature, m_touches);
        considerTouches(search, firstFeature + static_cast<int>(k), t);
    }
}

void ContactFinder::findOnSheetEdges(const SheetSearch& search)
{
    const SoftSurface& surface = search.m_fem.m_surface;
    const std::vector<Vec3>& x = search.m_fem.surfacePosition();
    const int firstFeature = surface.vertexCount() + static_cast<int>(surface.triangles().size());
    const std::vector<std::array<int, 2>>& edges = surface.features().m_edges;
    for (std::size_t k = 0; k < edges.size(); ++k)
    {
        const auto [a, b] = edges[k];
        SheetFeature feature;
        feature.m_corners[0] = x[a];
        feature.m_corners[1] = feature.m_corners[2] = x[b];
        feature.m_outward = unit(m_edgeOutward[k]);
        feature.m_halfAngle = 0.5 * norm(m_edgeOutward[k]);
        const double cosine = widestNormal(feature);
        feature.m_reach = m_band + std::max(alongCone(wayOf(search, a), feature.m_outward, cosine),
                                            alongCone(wayOf(search, b), feature.m_outward, cosine));
        feature.m_depth = kFeatureDepth * m_edge;
        feature.m_thickness = search.m_thickness;
        findEdgeTouches(m_soup, feature, m_touches);
        considerTouches(search, firstFeature + static_cast<int>(k), {a, b, a});
    }
}

void ContactFinder::considerTouches(const SheetSearch& search, int feature, const Triangle& nodes)
{
    const Target& target = search.m_target;
    for (const SheetTouch& touch : m_touches)
    {
        const std::size_t before = m_contacts.size();
        consider(search.m_fem, target, feature, nodes, touch.m_surface);
        if (m_contacts.size() == before) continue;
        m_origins.back().m_part = m_soup.triangles()[touch.m_triangle].m_part;
        m_origins.back().m_triangle = m_soup.triangles()[touch.m_triangle].m_index;
    }
}

}  // namespace bullet_fem
