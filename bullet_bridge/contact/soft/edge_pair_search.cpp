// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/edge_pair_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{
namespace
{

constexpr double kNormalArcSine = 0.03;  // tolerance (sine) of a normal outside the arc between two faces' normals
constexpr double kNormalArcSineAtImpact = 0.2;  // that tolerance at an impact, as the faces have rotated since the
                                                // start of the step
constexpr double kParallel = 0.05;       // sine of the angle between edges below which nearest points are not reliable
constexpr double kWayAsideShare = 1e-3;  // distance of the way out from the edges, over the depth
constexpr double kPositionRounding = 3e-7;  // relative rounding of positions in single precision
constexpr double kWayEnd = 0.01;            // share of the way at each side that lies on the surfaces

Vec3 along(const std::array<Vec3, 4>& ends, int first, double s)
{
    return (1 - s) * ends[first] + s * ends[first + 1];
}

// Vector from the second edge's point to the first edge's.
Vec3 between(const std::array<Vec3, 4>& ends, const LineParameters& at)
{
    return along(ends, 0, at.m_a) - along(ends, 2, at.m_b);
}

bool isInterior(const LineParameters& at)
{
    return at.m_a > kNegligibleLength && at.m_a < 1 - kNegligibleLength && at.m_b > kNegligibleLength &&
           at.m_b < 1 - kNegligibleLength;
}

Vec3 unitNormal(const std::array<Vec3, 4>& ends)
{
    const Vec3 n = cross(ends[1] - ends[0], ends[3] - ends[2]);
    return (1 / norm(n)) * n;
}

bool hasNode(const Triangle& triangle, int node)
{
    return std::find(triangle.begin(), triangle.end(), node) != triangle.end();
}

// True if a triangle intersects the segment from `from` to `from + way`. Triangles at the edge where the segment starts
// or ends do not count: they may slope away there.
bool isCrossed(const SoftSurface& surface, int edge, const Vec3& from, const Vec3& way)
{
    const std::array<int, 2>& ends = surface.topology().edges()[edge];
    CoarseBox box = CoarseBox::of(from, {});
    box.add(CoarseBox::of(from + way, {}));
    bool crossed = false;
    surface.tree().visitNear(box, 0,
                             [&](int t)
                             {
                                 const Triangle& nodes = surface.topology().triangles()[t];
                                 if (hasNode(nodes, ends[0]) && hasNode(nodes, ends[1])) return;
                                 const Corners c = surface.tree().corners(t);
                                 const Vec3 n = surface.faceNormal(t);
                                 const double s = dot(n, c[0] - from) / dot(n, way);
                                 std::array<double, 3> w;
                                 if (!(s > kWayEnd && s < 1 - kWayEnd) || !projectOnPlane(c, from + s * way, w)) return;
                                 crossed = crossed || std::min({w[0], w[1], w[2]}) >= 0;
                             });
    return crossed;
}

}  // namespace

void EdgePairSearch::find(const SoftSurface& first, const SoftSurface& second, const ContactReach& reach,
                          const NodesFound& nodes, const std::vector<EdgePair>& held,
                          std::vector<SurfaceContact>& touches)
{
    m_first = &first;
    m_second = &second;
    m_reach = reach;
    m_touches = &touches;
    const std::size_t begin = touches.size();
    listNear();
    for (const NearRidges::Run& runA : m_ridgesA.runs())
        for (const NearRidges::Run& runB : m_ridgesB.runs())
            if (mayTouch(runA.m_box, runB.m_box)) tryRuns(runA, runB, nodes);
    for (const EdgePair& pair : held) tryHeld(pair, nodes);
    const auto key = [](const SurfaceContact& touch) { return std::pair(touch.m_feature, touch.m_otherFeature); };
    std::sort(touches.begin() + begin, touches.end(),
              [&](const SurfaceContact& a, const SurfaceContact& b) { return key(a) < key(b); });
}

bool EdgePairSearch::areClose(const Pair& pair) const
{
    if (m_first != m_second) return false;
    const std::array<int, 4>& n = pair.m_nodes;
    const auto areClose = [this](int a, int b) { return m_first->areCloseAtRest(a, b); };
    return areClose(n[0], n[2]) || areClose(n[0], n[3]) || areClose(n[1], n[2]) || areClose(n[1], n[3]);
}

// Lists the ridges of either surface that are near the other surface.
void EdgePairSearch::listNear()
{
    const double near = m_reach.near(), band = m_reach.within();
    m_ridgesA.clear();
    m_ridgesB.clear();
    const CoarseBox boxA = NearRidges::bounds(*m_first, m_second->tree().coarseBounds(), near);
    const CoarseBox boxB = NearRidges::bounds(*m_second, boxA, near);
    if (boxB.isEmpty()) return;
    const Vec3 middle = middleOf(*m_first), direction = unit(middleOf(*m_second) - middle);
    const BeyondPlane planeA(*m_first, direction, SurfaceRidges::kSteps);
    const BeyondPlane planeB(*m_second, -direction, SurfaceRidges::kSteps);
    m_ridgesA.list(*m_first, {boxB, planeB, near, band}, middle);
    m_ridgesB.list(*m_second, {boxA, planeA, near, band}, middle);
    const double extent = std::max(m_ridgesA.extent(), m_ridgesB.extent());
    m_ridgeReach = {coarse(near), coarse(band), coarse(kPositionRounding * extent)};
}

// True if boxes that are swept over SurfaceRidges::kSteps steps come within reach.
bool EdgePairSearch::mayTouch(const CoarseBox& a, const CoarseBox& b) const
{
    return a.startsWithin(b, m_ridgeReach.m_near) || a.meets(b, m_ridgeReach.m_band);
}

void EdgePairSearch::tryRuns(const NearRidges::Run& runA, const NearRidges::Run& runB, const NodesFound& nodes)
{
    constexpr int kLanes = RidgeLanes::kCount;
    for (int a = runA.m_first; a < runA.m_end; ++a)
    {
        if (!mayTouch(m_ridgesA[a].m_box, runB.m_box)) continue;
        const RidgeLanes ridge = m_ridgesA.block(a / kLanes).spread(a % kLanes);
        for (int b = runB.m_first; b < runB.m_end; b += kLanes)
        {
            const RidgesMay may = ridgesMay(ridge, m_ridgesB.block(b / kLanes), m_ridgeReach);
            if (!isAny(may.m_cross | may.m_meet)) continue;
            const int count = std::min(kLanes, runB.m_end - b);
            for (int lane = 0; lane < count; ++lane)
                if (may.m_cross[lane] || may.m_meet[lane])
                    tryPair(m_ridgesA[a], m_ridgesB[b + lane], may.m_cross[lane] != 0, may.m_meet[lane] != 0, nodes);
        }
    }
}

void EdgePairSearch::tryPair(const NearRidges::Item& a, const NearRidges::Item& b, bool mayCross, bool mayMeet,
                             const NodesFound& nodes)
{
    if (m_first == m_second && b.m_ridge.m_edge <= a.m_ridge.m_edge) return;
    const Pair pair = pairOf(a.m_ridge, b.m_ridge);
    if (areClose(pair)) return;
    Crossing crossing;
    if (!(mayCross && tryNear(pair, nodes, crossing)) && !(mayMeet && tryImpact(pair, crossing))) return;
    // Impacts are searched beyond the end of the step, but count only between leaves that come close within it.
    if (m_first->tree().box(a.m_leaf).meets(m_second->tree().box(b.m_leaf), m_ridgeReach.m_near)) emit(pair, crossing);
}

EdgePairSearch::Pair EdgePairSearch::pairOf(const SurfaceRidges::Ridge& a, const SurfaceRidges::Ridge& b) const
{
    const std::vector<Vec3>&xA = m_first->position(), &xB = m_second->position();
    const std::vector<Vec3>&dA = m_first->change(), &dB = m_second->change();
    return {a.m_edge,
            b.m_edge,
            {a.m_a, a.m_b, b.m_a, b.m_b},
            {xA[a.m_a], xA[a.m_b], xB[b.m_a], xB[b.m_b]},
            {dA[a.m_a], dA[a.m_b], dB[b.m_a], dB[b.m_b]}};
}

// Tests an edge pair that pushed in the last step. Edges that press on each other flatten each other. If a flattened
// pair were dropped, the edges would bend back and push again, and a pile of soft balls would never come to rest. The
// surface may have changed since, so indices are checked.
void EdgePairSearch::tryHeld(const EdgePair& held, const NodesFound& nodes)
{
    const auto hasEdge = [](const SoftSurface& surface, int edge)
    { return edge >= 0 && edge < surface.topology().edgeCount(); };
    if (!hasEdge(*m_first, held.m_first) || !hasEdge(*m_second, held.m_second)) return;
    const double bendA = m_first->bend(held.m_first), bendB = m_second->bend(held.m_second);
    const bool areRidges = SurfaceRidges::isRidge(bendA) && SurfaceRidges::isRidge(bendB);
    if (areRidges || bendA > kRidgeSine || bendB > kRidgeSine) return;
    const auto edgeOf = [](const SoftSurface& surface, int edge)
    {
        const std::array<int, 2>& ends = surface.topology().edges()[edge];
        return SurfaceRidges::Ridge{edge, ends[0], ends[1]};
    };
    const Pair pair = pairOf(edgeOf(*m_first, held.m_first), edgeOf(*m_second, held.m_second));
    Crossing crossing;
    if (tryNear(pair, nodes, crossing)) emit(pair, crossing);
}

// True if the normal, from B to A, lies between the normals of both faces at either edge, up to the tolerance.
bool EdgePairSearch::separates(const Pair& pair, const Vec3& normal, double tolerance) const
{
    if (!(dot(normal, edgeNormal(*m_first, pair.m_edgeA)) < 0 && dot(normal, edgeNormal(*m_second, pair.m_edgeB)) > 0))
        return false;
    for (const Vec3& into : intoFaces(*m_first, pair.m_edgeA))
        if (!(dot(normal, into) >= -tolerance)) return false;
    for (const Vec3& into : intoFaces(*m_second, pair.m_edgeB))
        if (!(dot(normal, into) <= tolerance)) return false;
    return true;
}

// Tests for a crossing as the step begins: within the band, or closing within the step without far motion.
bool EdgePairSearch::tryNear(const Pair& pair, const NodesFound& nodes, Crossing& crossing) const
{
    if (!nearestOfLines(pair.m_x, kParallel, crossing.m_at) || !isInterior(crossing.m_at)) return false;
    crossing.m_normal = unitNormal(pair.m_x);
    if (!(dot(crossing.m_normal, edgeNormal(*m_first, pair.m_edgeA)) < 0)) crossing.m_normal = -crossing.m_normal;
    if (!separates(pair, crossing.m_normal, kNormalArcSine)) return false;
    crossing.m_gap = dot(crossing.m_normal, between(pair.m_x, crossing.m_at));
    if (crossing.m_gap >= m_reach.m_band)
    {
        const Vec3 travel = between(pair.m_change, crossing.m_at);
        return crossing.m_gap + dot(crossing.m_normal, travel) < m_reach.within() &&
               norm(travel) < m_reach.depth() + m_reach.m_fall;
    }
    // If an edge's node has a much shorter way out in another direction, that contact resolves the penetration.
    const auto ofFirst = [&](int k) { return nodes.m_ofFirst.depthAside(pair.m_nodes[k], crossing.m_normal); };
    const auto ofSecond = [&](int k) { return nodes.m_ofSecond.depthAside(pair.m_nodes[k], -crossing.m_normal); };
    const double shortest = std::min({ofFirst(0), ofFirst(1), ofSecond(2), ofSecond(3)});
    if (!(crossing.m_gap >= -std::min(m_reach.depth(), 2 * shortest))) return false;
    return crossing.m_gap >= -kNegligibleLength * m_reach.m_edge || isFreeWayOut(pair, crossing);
}

// True if nothing lies between edges that have passed each other. Edges on the far sides of two bars have both bars
// between them, and the bars need not overlap at all. The tested segment starts near the surfaces, inside of the edges
// and of faces that lean over it.
bool EdgePairSearch::isFreeWayOut(const Pair& pair, const Crossing& crossing) const
{
    const Vec3& n = crossing.m_normal;
    const auto inward = [&](const std::array<Vec3, 2>& into)
    {
        const bool firstIsFlatter = std::fabs(dot(into[0], n)) < std::fabs(dot(into[1], n));
        const Vec3 &flatter = into[firstIsFlatter ? 0 : 1], &steeper = into[firstIsFlatter ? 1 : 0];
        const Vec3 inside = flatter - dot(flatter, n) * n;
        const double over = dot(steeper, inside);
        return (kWayAsideShare + (over > 0 ? std::min(over / std::fabs(dot(steeper, n)), 1.0) : 0)) * inside;
    };
    const Vec3 way = -crossing.m_gap * n;  // from A's edge to B's
    const Vec3 aside =
        -crossing.m_gap * (inward(intoFaces(*m_first, pair.m_edgeA)) + inward(intoFaces(*m_second, pair.m_edgeB)));
    const Vec3 from = along(pair.m_x, 0, crossing.m_at.m_a) + aside;
    return !isCrossed(*m_first, pair.m_edgeA, from, way) && !isCrossed(*m_second, pair.m_edgeB, from, way);
}

// True if the first edge stays on one side of the second along a direction, from the start to kSteps steps later. Nodes
// move on straight lines, so both times suffice.
bool EdgePairSearch::stayApart(const Pair& pair, const Vec3& direction)
{
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (int a = 0; a < 2; ++a)
        for (int b = 2; b < 4; ++b)
        {
            const double before = dot(direction, pair.m_x[a] - pair.m_x[b]);
            const double after = before + SurfaceRidges::kSteps * dot(direction, pair.m_change[a] - pair.m_change[b]);
            least = std::min({least, before, after});
            most = std::max({most, before, after});
        }
    return least > 0 || most < 0;
}

// Cheap sufficient tests that edges cannot meet: they stay apart along their common normal, or across their relative
// path.
bool EdgePairSearch::cannotMeet(const Pair& pair, const Vec3& travel)
{
    const Vec3 a = pair.m_x[1] - pair.m_x[0], b = pair.m_x[3] - pair.m_x[2];
    return stayApart(pair, cross(a, b)) || stayApart(pair, cross(a, travel)) || stayApart(pair, cross(b, travel));
}

// Tests whether the edges meet on their paths (continuous collision detection).
bool EdgePairSearch::tryImpact(const Pair& pair, Crossing& crossing) const
{
    const std::array<Vec3, 4>&x = pair.m_x, &change = pair.m_change;
    const Vec3 way = between(change, {0.5, 0.5});
    const double travel = norm(way);
    if (!(travel > m_reach.m_band) || cannotMeet(pair, way)) return false;
    const std::array<MovingVector, 3> vectors = {MovingVector{x[2] - x[0], change[2] - change[0]},
                                                 MovingVector{x[1] - x[0], change[1] - change[0]},
                                                 MovingVector{x[3] - x[2], change[3] - change[2]}};
    std::array<double, 3> times;
    const int count = timesInOnePlane(vectors, std::min(2.0, 1 + m_reach.within() / travel), times);
    for (int k = 0; k < count; ++k)
    {
        std::array<Vec3, 4> then;
        for (int a = 0; a < 4; ++a) then[a] = x[a] + times[k] * change[a];
        if (!nearestOfLines(then, kParallel, crossing.m_at) || !isInterior(crossing.m_at)) continue;
        crossing.m_normal = unitNormal(then);
        crossing.m_gap = dot(crossing.m_normal, between(x, crossing.m_at));
        if (crossing.m_gap < 0)
        {
            crossing.m_normal = -crossing.m_normal;
            crossing.m_gap = -crossing.m_gap;
        }
        if (separates(pair, crossing.m_normal, kNormalArcSineAtImpact)) return true;
    }
    return false;
}

void EdgePairSearch::emit(const Pair& pair, const Crossing& crossing)
{
    if (!std::isfinite(crossing.m_gap) || !isFinite(crossing.m_normal)) return;
    const std::array<int, 4>& n = pair.m_nodes;
    const LineParameters& at = crossing.m_at;
    m_touches->push_back({{n[0], n[1], n[0]},
                          {n[2], n[3], n[2]},
                          {1 - at.m_a, at.m_a, 0},
                          {1 - at.m_b, at.m_b, 0},
                          crossing.m_normal,
                          crossing.m_gap,
                          pair.m_edgeA,
                          pair.m_edgeB});
}

}  // namespace bullet_fem
