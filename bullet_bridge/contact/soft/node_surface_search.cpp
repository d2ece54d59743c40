// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/node_surface_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGrooveReach = 0.05;            // how far it extends beyond a concave edge, in edges
constexpr double kFacingCosineAtImpact = -0.25;  // that cosine at an impact: grazing faces follow others that are met
                                                 // first
constexpr double kSeparatingSine = -0.05;        // smallest sine of a body's edges above a separating plane
constexpr double kCornerWeight = 2e-3;  // largest barycentric weight that counts as zero, near a corner or edge
constexpr double kDeepest = 3;          // largest depth along a way out over the distance from the surface

double height(const Corners& t, int corner)
{
    const Vec3 opposite = t[(corner + 2) % 3] - t[(corner + 1) % 3];
    return norm(cross(t[1] - t[0], t[2] - t[0])) / norm(opposite);
}

}  // namespace

void NodeSurfaceSearch::find(const SoftSurface& nodes, const SoftSurface& faces, const ContactReach& reach,
                             const NodeSurfaceSearch* done, std::vector<SurfaceContact>& touches)
{
    m_nodes = &nodes;
    m_faces = &faces;
    m_done = done;
    m_reach = reach;
    m_touches = &touches;
    forget();
    listNear();
    m_guess = -1;
    for (int i : m_near) findNode(i);
}

double NodeSurfaceSearch::depthAside(int node, const Vec3& direction) const
{
    return m_depth[node] < kInfinity && dot(m_wayOut[node], direction) < kSameNormalCosine ? m_depth[node] : kInfinity;
}

void NodeSurfaceSearch::forget()
{
    for (int i : m_near)
    {
        m_depth[i] = kInfinity;
        m_partner[i] = -1;
    }
    m_near.clear();
    m_near.reserve(m_nodes->topology().vertices().size());
    const std::size_t count = m_nodes->position().size();
    if (m_depth.size() >= count) return;
    m_depth.resize(count, kInfinity);
    m_wayOut.resize(count);
    m_partner.resize(count, -1);
}

// Lists the nodes that may reach the bounds of the faces, conservatively.
void NodeSurfaceSearch::listNear()
{
    m_nodes->tree().visitNear(m_faces->tree().coarseBounds(), m_reach.within(),
                              [this](int t)
                              {
                                  for (int i : m_nodes->topology().triangles()[t])
                                      if (*m_nodes->topology().trianglesAt(i).begin() == t) m_near.push_back(i);
                              });
    std::sort(m_near.begin(), m_near.end());
}

bool NodeSurfaceSearch::isClose(int node, int triangle) const
{
    if (m_nodes != m_faces) return false;
    const Triangle& t = m_faces->topology().triangles()[triangle];
    return m_faces->areCloseAtRest(node, t[0]) || m_faces->areCloseAtRest(node, t[1]) ||
           m_faces->areCloseAtRest(node, t[2]);
}

void NodeSurfaceSearch::findNode(int node)
{
    Visit visit;
    visit.m_node = node;
    visit.m_x = m_nodes->position()[node];
    visit.m_change = m_nodes->change()[node];
    if (!lookAround(visit)) return;
    visit.m_normal = nodeNormal(*m_nodes, node);
    m_hits.clear();
    m_faces->tree().visitNear(CoarseBox::of(visit.m_x, visit.m_change),
                              std::max(m_reach.within(), std::min(visit.m_limit, m_reach.depth())),
                              [&](int t)
                              {
                                  if (!isClose(node, t)) tryFace(visit, t);
                              });
    if (visit.m_limit > m_reach.depth()) tryDeepFace(visit);
    choose(visit);
    for (const Hit& hit : m_hits)
        if (!hit.m_dropped) emit(visit, hit);
    if (std::all_of(m_hits.begin(), m_hits.end(), [](const Hit& hit) { return hit.m_dropped; }))
        tryNearestFeature(visit);
}

// Finds the nearest point of the surface, and whether the node is inside. False if nothing is within reach.
bool NodeSurfaceSearch::lookAround(Visit& visit)
{
    const SweptBox point = SweptBox::of(visit.m_x, visit.m_change);
    const SweptBox& bounds = m_faces->tree().bounds();
    if (!bounds.meets(point, m_reach.within())) return false;
    const double travel = largestTravel(point, bounds);
    const bool self = m_nodes == m_faces;
    const bool maybeInside = !self && bounds.m_start.squaredDistance(visit.m_x) == 0;
    const double most = maybeInside ? kInfinity : std::max(m_reach.within(), m_reach.depth()) + travel;
    visit.m_nearestTriangle = m_faces->tree().nearestTriangle(
        visit.m_x, most, [&](int t) { return isClose(visit.m_node, t); }, visit.m_nearest, m_guess);
    if (visit.m_nearestTriangle < 0) return false;
    m_guess = visit.m_nearestTriangle;
    const Vec3 r = visit.m_x - visit.m_nearest.m_point;
    visit.m_distance = norm(r);
    visit.m_inside = dot(r, normalAt(*m_faces, visit.m_nearestTriangle, visit.m_nearest)) < 0;
    if (self)  // its own far side is behind the node, too: only shallow depths count
        visit.m_limit = m_reach.depth();
    else if (visit.m_inside)
        visit.m_limit = std::max(kDeepest * visit.m_distance, m_reach.depth());
    // on a rim, rounding decides between inside and outside
    else if (visit.m_distance < kNegligibleLength * m_reach.m_edge)
        visit.m_limit = kGrooveReach * m_reach.m_edge;
    return visit.m_inside || self || visit.m_distance <= m_reach.within() + travel;
}

// Classifies a projection: over the face, or beyond an edge by less than that edge permits. False if farther.
bool NodeSurfaceSearch::placeOf(int triangle, const std::array<double, 3>& weights, Place& place) const
{
    place = Place::over;
    for (int k = 0; k < 3; ++k)
    {
        if (weights[k] >= 0) continue;
        const int edge = m_faces->topology().edgesOf(triangle)[(k + 1) % 3];
        const bool groove = m_faces->bend(edge) > kRidgeSine;
        const double beyond = -weights[k] * height(m_faces->tree().corners(triangle), k);
        if (beyond > (groove ? kGrooveReach : kNegligibleLength) * m_reach.m_edge) return false;
        place = groove && place != Place::rim ? Place::groove : Place::rim;
    }
    return true;
}

void NodeSurfaceSearch::tryFace(const Visit& visit, int triangle)
{
    const Corners corners = m_faces->tree().corners(triangle);
    Hit hit = {triangle, {}, m_faces->faceNormal(triangle), 0, 0, Place::over, false};
    if (!projectOnPlane(corners, visit.m_x, hit.m_weights)) return;
    hit.m_gap = dot(hit.m_normal, visit.m_x - corners[0]);
    if (!(hit.m_gap >= -visit.m_limit)) return;
    if (isFacing(visit, triangle) && placeOf(triangle, hit.m_weights, hit.m_place) && isNear(visit, hit))
        m_hits.push_back(hit);
    else if (hit.m_gap > 0 && !staysAside(visit, hit))
        tryImpact(visit, triangle);
}

// For a node deeper than a step permits: tests the nearest face that opposes its normal.
void NodeSurfaceSearch::tryDeepFace(const Visit& visit)
{
    const auto isTurnedAway = [&](int t) { return !isFacing(visit, t); };
    TrianglePoint nearest;
    const int found = m_faces->tree().nearestTriangle(visit.m_x, visit.m_limit, isTurnedAway, nearest);
    const auto isFound = [&](const Hit& hit) { return hit.m_triangle == found; };
    if (found >= 0 && std::none_of(m_hits.begin(), m_hits.end(), isFound)) tryFace(visit, found);
}

bool NodeSurfaceSearch::isFacing(const Visit& visit, int triangle) const
{
    return dot(visit.m_normal, m_faces->faceNormal(triangle)) < kFacingCosine;
}

// True if the node is within the band as the step begins, or closes within the step without moving far along the face.
bool NodeSurfaceSearch::isNear(const Visit& visit, const Hit& hit) const
{
    if (hit.m_gap < m_reach.m_band) return true;
    const Vec3 travel = visit.m_change -
                        interpolated(m_faces->change(), m_faces->topology().triangles()[hit.m_triangle], hit.m_weights);
    return hit.m_gap + dot(hit.m_normal, travel) < m_reach.within() && norm(travel) < m_reach.depth() + m_reach.m_fall;
}

// Cheap sufficient test that a node does not meet a face: before and after the step it lies in front of all corners, or
// beyond them across its path. Nodes move on straight lines, so both times suffice.
bool NodeSurfaceSearch::staysAside(const Visit& visit, const Hit& hit) const
{
    const Triangle& t = m_faces->topology().triangles()[hit.m_triangle];
    const std::vector<Vec3>&x = m_faces->position(), &change = m_faces->change();
    const auto isBeyond = [&](const Vec3& direction)
    {
        double least = kInfinity;
        for (int i : t)
            least = std::min(least, dot(direction, visit.m_x - x[i]) +
                                        2 * std::min(0.0, dot(direction, visit.m_change - change[i])));
        return least > m_reach.within() * norm(direction);
    };
    if (isBeyond(hit.m_normal)) return true;
    for (int k = 0; k < 3; ++k)
    {
        const Vec3 &a = x[t[k]], &b = x[t[(k + 1) % 3]], &opposite = x[t[(k + 2) % 3]];
        const Vec3 across = cross(b - a, visit.m_change - change[t[k]]);
        if (isBeyond(dot(across, opposite - a) < 0 ? across : -across)) return true;
    }
    return false;
}

// Tests whether a node in front of a face meets it on its path (continuous collision detection).
void NodeSurfaceSearch::tryImpact(const Visit& visit, int triangle)
{
    const Triangle& t = m_faces->topology().triangles()[triangle];
    const std::vector<Vec3>&x = m_faces->position(), &change = m_faces->change();
    const Vec3 middle = (1.0 / 3) * (change[t[0]] + change[t[1]] + change[t[2]]);
    const double travel = norm(visit.m_change - middle);
    if (!(travel > m_reach.m_band)) return;
    const std::array<MovingVector, 3> vectors = {MovingVector{visit.m_x - x[t[0]], visit.m_change - change[t[0]]},
                                                 MovingVector{x[t[1]] - x[t[0]], change[t[1]] - change[t[0]]},
                                                 MovingVector{x[t[2]] - x[t[0]], change[t[2]] - change[t[0]]}};
    std::array<double, 3> times;
    const int count = timesInOnePlane(vectors, std::min(2.0, 1 + m_reach.within() / travel), times);
    for (int k = 0; k < count; ++k)
    {
        const double time = times[k];
        const Corners then = {x[t[0]] + time * change[t[0]], x[t[1]] + time * change[t[1]],
                              x[t[2]] + time * change[t[2]]};
        Hit hit = {triangle, {}, {}, 0, time, Place::over, false};
        if (!projectOnPlane(then, visit.m_x + time * visit.m_change, hit.m_weights)) continue;
        if (std::min({hit.m_weights[0], hit.m_weights[1], hit.m_weights[2]}) < -kGrooveReach) continue;
        const Vec3 normal = cross(then[1] - then[0], then[2] - then[0]);
        hit.m_normal = (1 / norm(normal)) * normal;
        hit.m_gap = dot(hit.m_normal, visit.m_x - interpolated(x, t, hit.m_weights));
        if (!(hit.m_gap > 0) || dot(visit.m_normal, hit.m_normal) > kFacingCosineAtImpact) continue;
        m_hits.push_back(hit);
        return;
    }
}

// Keeps a face beyond its rim only if the node lies over no other face; of several, the one that opposes the node's
// normal most.
void NodeSurfaceSearch::dropRims(const Visit& visit)
{
    Hit* best = nullptr;
    bool over = false;
    const auto facing = [&](const Hit& hit) { return dot(visit.m_normal, hit.m_normal); };
    for (Hit& hit : m_hits)
    {
        if (hit.m_time > 0) continue;
        if (hit.m_place != Place::rim)
            over = over || hit.m_gap < m_reach.m_band;
        else if (!best || facing(hit) < facing(*best))
            best = &hit;
    }
    for (Hit& hit : m_hits) hit.m_dropped = hit.m_place == Place::rim && (over || &hit != best);
}

// Keeps the nearest face as the way out of the body, and a second one where that ends in a groove; and the first
// impact.
void NodeSurfaceSearch::choose(const Visit& visit)
{
    std::sort(m_hits.begin(), m_hits.end(), [](const Hit& a, const Hit& b) { return a.m_triangle < b.m_triangle; });
    dropRims(visit);
    double least = -kInfinity, first = kInfinity;
    for (const Hit& hit : m_hits)
    {
        if (!hit.m_dropped && hit.m_gap < 0) least = std::max(least, hit.m_gap);
        if (hit.m_time > 0) first = std::min(first, hit.m_time);
    }
    for (Hit& hit : m_hits)
        if ((hit.m_gap < least && hit.m_place != Place::groove) || hit.m_time > first) hit.m_dropped = true;
    dropContinuations();
}

// Keeps the nearest of faces that continue each other.
void NodeSurfaceSearch::dropContinuations()
{
    for (Hit& a : m_hits)
        for (const Hit& b : m_hits)
        {
            if (&a == &b || a.m_dropped || b.m_dropped || dot(a.m_normal, b.m_normal) < kFlatCosine) continue;
            if (b.m_gap < a.m_gap || (b.m_gap == a.m_gap && b.m_triangle < a.m_triangle)) a.m_dropped = true;
        }
}

// Tests the nearest edge or corner, for a node that lies over no face.
void NodeSurfaceSearch::tryNearestFeature(const Visit& visit)
{
    if (visit.m_inside || visit.m_nearest.m_feature == TriangleFeature::face) return;
    if (!(visit.m_distance > 1e-9 * m_reach.m_edge) || visit.m_distance > m_reach.within() + m_reach.depth()) return;
    const Vec3 normal = (1 / visit.m_distance) * (visit.m_x - visit.m_nearest.m_point);
    const Hit hit = {
        visit.m_nearestTriangle, visit.m_nearest.m_weights, normal, visit.m_distance, 0, Place::over, false};
    if (!isNear(visit, hit) || minAlongEdges(*m_nodes, visit.m_node, normal) < kSeparatingSine) return;
    if (dot(visit.m_normal, normal) > kFacingCosine) return;
    const std::size_t count = m_touches->size();
    emit(visit, hit);
    if (m_touches->size() > count) m_touches->back().m_otherFeature = -1;
}

// True if the search with exchanged surfaces has found this pair of nodes already.
bool NodeSurfaceSearch::isPairedAlready(int node, int corner) const
{
    if (m_nodes == m_faces) return m_partner[corner] == node;
    return m_done && m_done->m_partner[corner] == node;
}

void NodeSurfaceSearch::emit(const Visit& visit, const Hit& hit)
{
    const Triangle& t = m_faces->topology().triangles()[hit.m_triangle];
    const int node = visit.m_node;
    SurfaceContact touch = {{node, node, node}, t,         {1, 0, 0}, hit.m_weights,
                            hit.m_normal,       hit.m_gap, node,      hit.m_triangle};
    // On a nearly flat corner or edge all faces are equal: their mean normal keeps forces steady.
    const auto useNormal = [&](const Vec3& normal)
    {
        touch.m_normal = normal;
        touch.m_gap = dot(normal, visit.m_x - interpolated(m_faces->position(), t, hit.m_weights));
    };
    int corner = -1, thin = -1;
    for (int k = 0; k < 3; ++k)
    {
        if (hit.m_weights[k] > 1 - kCornerWeight) corner = k;
        if (hit.m_weights[k] < kCornerWeight) thin = k;
    }
    if (corner >= 0 && hit.m_time == 0)
    {
        if (isPairedAlready(node, t[corner])) return;
        m_partner[node] = t[corner];
        if (isFlatNode(*m_faces, t[corner])) useNormal(nodeNormal(*m_faces, t[corner]));
    }
    else if (thin >= 0 && hit.m_time == 0)
    {
        const int edge = m_faces->topology().edgesOf(hit.m_triangle)[(thin + 1) % 3];
        if (isFlatEdge(*m_faces, edge)) useNormal(edgeNormal(*m_faces, edge));
    }
    if (!std::isfinite(touch.m_gap) || !isFinite(touch.m_normal)) return;
    if (touch.m_gap < 0 && -touch.m_gap < m_depth[node])
    {
        m_depth[node] = -touch.m_gap;
        m_wayOut[node] = touch.m_normal;
    }
    m_touches->push_back(touch);
}

}  // namespace bullet_fem
