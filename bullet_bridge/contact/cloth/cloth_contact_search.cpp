// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/cloth/cloth_contact_search.h"

#include <cmath>
#include <limits>

#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPassedCosine = 0.5;  // smallest |cosine| between a vertex's normal and a face's that it has passed
constexpr double kDeepest = 0.5;       // largest penetration of a face by a vertex, in mean edges
constexpr double kOnIt = 1e-9;         // smallest distance that gives a direction, in mean edges
constexpr int kMaxAdvances = 32;       // of conservative advancement

const auto kNone = [](int) { return false; };

}  // namespace

void ClothContactSearch::find(std::vector<ClothContact>& touches)
{
    for (int i = 0; i < m_cloth.nodeCount(); ++i) findNode(i, touches);
    if (!m_cloth.tree()) return;
    for (int vertex : m_surface.topology().vertices()) findVertex(vertex, touches);
}

// Conservative advancement of a node or vertex along its path relative to the nearest triangle, until it is within the
// band. Returns false if it does not get there in this step.
template <class Look>
bool ClothContactSearch::arrive(const Mover& mover, const std::vector<Vec3>& change,
                                const std::vector<Triangle>& triangles, const Look& look, Place& place) const
{
    const Vec3 way = mover.m_change - interpolated(change, triangles[place.m_triangle], place.m_nearest.m_weights);
    const double length = norm(way);
    if (!(length > 0)) return false;
    double time = 0;
    for (int k = 0; k < kMaxAdvances; ++k)
    {
        time += (place.m_distance - m_thickness) / length;
        if (time > 1 || !look(mover.m_x + time * way, place)) return false;
        if (place.m_distance - m_thickness < m_band) return true;
    }
    return false;
}

// Finds the nearest point of the surface. Returns false if it is farther than `most`.
bool ClothContactSearch::lookAtSurface(const Vec3& x, double most, Place& place) const
{
    place.m_triangle = m_surface.tree().nearestTriangle(x, most, kNone, place.m_nearest);
    if (place.m_triangle < 0) return false;
    const Vec3 r = place.m_nearest.m_point - x, outward = normalAt(m_surface, place.m_triangle, place.m_nearest);
    const double distance = norm(r);
    const bool inside = dot(r, outward) > 0;
    place.m_distance = inside ? -distance : distance;
    place.m_normal =
        distance > kOnIt * m_surface.meanEdge() ? (1 / place.m_distance) * r : -m_surface.faceNormal(place.m_triangle);
    return true;
}

void ClothContactSearch::findNode(int node, std::vector<ClothContact>& touches) const
{
    const Mover mover = {node, m_cloth.position()[node], m_cloth.change()[node], {}};
    const SweptBox point = SweptBox::of(mover.m_x, mover.m_change);
    const SweptBox& bounds = m_surface.tree().bounds();
    const double within = m_thickness + m_band;
    if (!bounds.meets(point, within)) return;
    const bool maybeInside = bounds.m_start.squaredDistance(mover.m_x) == 0;
    const double most = maybeInside ? kInfinity : within + largestTravel(point, bounds);
    Place place;
    if (!lookAtSurface(mover.m_x, most, place)) return;
    const auto look = [&](const Vec3& x, Place& at) { return lookAtSurface(x, kInfinity, at); };
    if (!(place.m_distance < within) &&
        !arrive(mover, m_surface.change(), m_surface.topology().triangles(), look, place))
        return;
    ClothContact touch = {m_surface.topology().triangles()[place.m_triangle],
                          {node, node, node},
                          place.m_nearest.m_weights,
                          {1, 0, 0},
                          mover.m_x,
                          place.m_nearest.m_point,
                          place.m_normal,
                          0};
    touch.m_gap = dot(place.m_normal, place.m_nearest.m_point - mover.m_x) - m_thickness;
    if (std::isfinite(touch.m_gap) && isFinite(touch.m_normal)) touches.push_back(touch);
}

// Finds the nearest point of the cloth if the vertex faces it, or has passed it by less than kDeepest. Returns false
// otherwise.
bool ClothContactSearch::lookAtCloth(const Mover& mover, const Vec3& x, double most, Place& place) const
{
    place.m_triangle = m_cloth.tree()->nearestTriangle(x, most, kNone, place.m_nearest);
    if (place.m_triangle < 0) return false;
    const Vec3 r = x - place.m_nearest.m_point;
    place.m_distance = norm(r);
    if (place.m_distance > kOnIt * m_surface.meanEdge() && dot(r, mover.m_normal) < kFacingCosine * place.m_distance)
    {
        place.m_normal = (1 / place.m_distance) * r;
        return true;
    }
    if (place.m_nearest.m_feature != TriangleFeature::face || place.m_distance > kDeepest * m_surface.meanEdge())
        return false;
    const Corners t = m_cloth.tree()->corners(place.m_triangle);
    const Vec3 across = normalOf(t);
    const double facing = dot(across, mover.m_normal);
    if (!(std::fabs(facing) > kPassedCosine)) return false;
    place.m_normal = facing < 0 ? across : -across;
    place.m_distance = -place.m_distance;
    return true;
}

void ClothContactSearch::findVertex(int vertex, std::vector<ClothContact>& touches) const
{
    Mover mover = {vertex, m_surface.position()[vertex], m_surface.change()[vertex], {}};
    const SweptBox point = SweptBox::of(mover.m_x, mover.m_change);
    const SweptBox& bounds = m_cloth.tree()->bounds();
    const double within = m_thickness + m_band;
    if (!bounds.meets(point, within)) return;
    mover.m_normal = nodeNormal(m_surface, vertex);
    Place place;
    if (!lookAtCloth(mover, mover.m_x, within + kDeepest * m_surface.meanEdge() + largestTravel(point, bounds), place))
        return;
    const auto look = [&](const Vec3& x, Place& at) { return lookAtCloth(mover, x, kInfinity, at); };
    if (!(place.m_distance < within) && !arrive(mover, m_cloth.change(), m_cloth.triangles(), look, place)) return;
    const Triangle& t = m_cloth.triangles()[place.m_triangle];
    ClothContact touch = {{vertex, vertex, vertex}, t, {1, 0, 0}, place.m_nearest.m_weights, {}, mover.m_x,
                          place.m_normal,           0};
    touch.m_point = interpolated(m_cloth.position(), t, place.m_nearest.m_weights);
    touch.m_gap = dot(place.m_normal, mover.m_x - touch.m_point) - m_thickness;
    if (std::isfinite(touch.m_gap) && isFinite(touch.m_normal)) touches.push_back(touch);
}

}  // namespace bullet_fem
