// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_bridge/geometry/shapes/convex_distance.h"

namespace bullet_fem
{

namespace
{

constexpr int maxPoints = 96;
constexpr int maxFaces = 2 * maxPoints;  // a closed surface of n points has 2 n - 4 triangles
constexpr double flatness = 1e-11;       // largest distance from a plane that counts as in it, relative to the size [-]
constexpr double curvedAccuracy = 1e-6;  // relative to the size [-]: finer polytopes of curved cores consist of slivers

/// The convex polytope of EPA: it grows inside the Minkowski difference until its face nearest to the origin lies on
/// the boundary. A start polytope may exclude the origin: faces with the origin outside are expanded first.
class Polytope
{
public:
    explicit Polytope(const MinkowskiDifference& difference) : m_difference(difference) {}

    /// Starts with a tetrahedron of well separated points. False if the difference is flat; m_flatNormal is then its
    /// normal.
    bool start();
    /// Expands the face nearest to the origin. False if that face lies on the boundary, or rounding permits no
    /// progress.
    bool expand();
    SurfaceDistance result() const;

    Vec3 m_flatNormal = {0, 1, 0};

private:
    struct Face
    {
        std::array<int, 3> m_points;  ///< counter-clockwise from outside
        Vec3 m_normal;                ///< unit, outward
        double m_distance;  ///< signed distance of the origin below the face [m]; negative if the origin is outside
    };
    struct Edge
    {
        int m_from, m_to;
    };

    double height(const Face& face, const Vec3& w) const { return dot(face.m_normal, w) - face.m_distance; }
    void addPoint(const MinkowskiPoint& point);
    bool makeFace(int a, int b, int c, Face& face) const;
    int nearestFace() const;
    int farthestOf(const MinkowskiPoint* candidates, int count, const Vec3& from, const Mat3& projection) const;
    int openAround(const Vec3& w, std::array<Edge, 3 * maxFaces>& horizon);

    const MinkowskiDifference& m_difference;
    std::array<MinkowskiPoint, maxPoints> m_points;
    std::array<Face, maxFaces> m_faces;
    int m_pointCount = 0, m_faceCount = 0;
    double m_size = 0;  ///< largest distance of a point from the origin [m]
};

void Polytope::addPoint(const MinkowskiPoint& point)
{
    m_points[m_pointCount++] = point;
    m_size = std::max(m_size, norm(point.m_w));
}

/// False if the three points are collinear.
bool Polytope::makeFace(int a, int b, int c, Face& face) const
{
    const Vec3 ab = m_points[b].m_w - m_points[a].m_w, ac = m_points[c].m_w - m_points[a].m_w, n = cross(ab, ac);
    const double area = norm(n);
    if (!(area > 1e-13 * norm(ab) * norm(ac))) return false;
    face = {{a, b, c}, n * (1 / area), 0};
    face.m_distance = dot(face.m_normal, m_points[a].m_w);
    return true;
}

/// Index of the candidate with the largest projected distance from a point.
int Polytope::farthestOf(const MinkowskiPoint* candidates, int count, const Vec3& from, const Mat3& projection) const
{
    int farthest = 0;
    for (int i = 1; i < count; ++i)
        if (norm(projection * (candidates[i].m_w - from)) > norm(projection * (candidates[farthest].m_w - from)))
            farthest = i;
    return farthest;
}

bool Polytope::start()
{
    const auto support = [this](const Vec3& d) { return m_difference.support(d); };
    const MinkowskiPoint ends[] = {support({1, 0, 0}),  support({-1, 0, 0}), support({0, 1, 0}),
                                   support({0, -1, 0}), support({0, 0, 1}),  support({0, 0, -1})};
    addPoint(ends[0]);
    const Vec3 a = ends[0].m_w;
    const Mat3 I = Mat3::identity();
    addPoint(ends[farthestOf(ends, 6, a, I)]);
    const Vec3 ab = m_points[1].m_w - a;
    if (!(norm(ab) > flatness * m_size)) return false;

    // A direction perpendicular to the line, from the axis that it is least parallel to.
    const Vec3 along = ab * (1 / norm(ab));
    int least = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(along[i]) < std::abs(along[least])) least = i;
    Vec3 axis;
    axis[least] = 1;
    Vec3 across = cross(along, axis);
    across *= 1 / norm(across);
    const Vec3 other = cross(along, across);
    m_flatNormal = across;
    const MinkowskiPoint sides[] = {support(across), support(-across), support(other), support(-other)};
    const Mat3 fromLine = I - outer(along, along);
    addPoint(sides[farthestOf(sides, 4, a, fromLine)]);
    if (!(norm(fromLine * (m_points[2].m_w - a)) > flatness * m_size)) return false;

    Vec3 n = cross(ab, m_points[2].m_w - a);
    n *= 1 / norm(n);
    m_flatNormal = n;
    const MinkowskiPoint tops[] = {support(n), support(-n)};
    addPoint(tops[farthestOf(tops, 2, a, outer(n, n))]);
    const double top = dot(n, m_points[3].m_w - a);
    if (!(std::abs(top) > flatness * m_size)) return false;
    if (top > 0) std::swap(m_points[1], m_points[2]);  // the fourth point is now below the first three

    m_faceCount = 4;
    return makeFace(0, 1, 2, m_faces[0]) && makeFace(0, 3, 1, m_faces[1]) && makeFace(1, 3, 2, m_faces[2]) &&
           makeFace(2, 3, 0, m_faces[3]);
}

int Polytope::nearestFace() const
{
    const auto nearer = [](const Face& f, const Face& g) { return f.m_distance < g.m_distance; };
    return int(std::min_element(m_faces.begin(), m_faces.begin() + m_faceCount, nearer) - m_faces.begin());
}

/// Removes the faces that are visible from w, coplanar ones included, which would leave slivers. Returns the number of
/// edges of the horizon.
int Polytope::openAround(const Vec3& w, std::array<Edge, 3 * maxFaces>& horizon)
{
    int edges = 0, kept = 0;
    for (int f = 0; f < m_faceCount; ++f)
    {
        const Face face = m_faces[f];
        if (height(face, w) < -flatness * m_size)
        {
            m_faces[kept++] = face;
            continue;
        }
        for (int i = 0; i < 3; ++i)
        {
            const Edge edge = {face.m_points[i], face.m_points[(i + 1) % 3]};
            const auto end = horizon.begin() + edges;
            const auto twin =
                std::find_if(horizon.begin(), end,
                             [&edge](const Edge& e) { return e.m_from == edge.m_to && e.m_to == edge.m_from; });
            if (twin == end)
                horizon[edges++] = edge;
            else
                *twin = horizon[--edges];
        }
    }
    m_faceCount = kept;
    return edges;
}

bool Polytope::expand()
{
    const Face best = m_faces[nearestFace()];
    const MinkowskiPoint next = m_difference.support(best.m_normal);
    const double accuracy = (m_difference.m_core.isCurved() ? curvedAccuracy : 10 * flatness) * m_size;
    if (m_pointCount == maxPoints || !(height(best, next.m_w) > accuracy)) return false;

    const std::array<Face, maxFaces> before = m_faces;
    const int countBefore = m_faceCount;
    addPoint(next);
    std::array<Edge, 3 * maxFaces> horizon;
    const int edges = openAround(next.m_w, horizon);
    bool closed = edges >= 3 && m_faceCount + edges <= maxFaces;
    for (int e = 0; closed && e < edges; ++e)
        closed = makeFace(horizon[e].m_from, horizon[e].m_to, m_pointCount - 1, m_faces[m_faceCount++]);
    // With the origin inside, the nearest face of a growing convex polytope only moves outward. Otherwise rounding has
    // broken the polytope.
    const bool isBroken =
        !closed || (best.m_distance > 0 && m_faces[nearestFace()].m_distance < best.m_distance - flatness * m_size);
    if (!isBroken) return true;
    m_faces = before;
    m_faceCount = countBefore;
    return false;
}

SurfaceDistance Polytope::result() const
{
    // A flat side of the difference is several triangles: takes the one with the origin's projection.
    const Face& best = m_faces[nearestFace()];
    MinkowskiSimplex foot;
    double footDistance = -1;
    for (int f = 0; f < m_faceCount; ++f)
    {
        const Face& face = m_faces[f];
        if (face.m_distance > best.m_distance + 100 * flatness * m_size || dot(face.m_normal, best.m_normal) < 1 - 1e-6)
            continue;
        MinkowskiSimplex corners;
        for (int i : face.m_points) corners.m_points[corners.m_count++] = m_points[i];
        bool inside;
        const double d = norm(corners.reduceToNearest(inside));
        if (footDistance >= 0 && d >= footDistance) continue;
        foot = corners;
        footDistance = d;
    }
    return {-best.m_distance - m_difference.m_core.rounding(), -best.m_normal, foot.softBarycentric()};
}

/// Orients the normal by the soft triangle: a core in its plane is taken to be outside of the soft body.
Vec3 flatDirection(const MinkowskiDifference& difference, const Vec3& normal)
{
    if (difference.m_softCount < 3) return normal;
    const Vec3* soft = difference.m_soft;
    const Vec3 outward = cross(soft[1] - soft[0], soft[2] - soft[0]);
    return dot(outward, normal) > 0 ? -normal : normal;
}

}  // namespace

SurfaceDistance penetration(const MinkowskiDifference& difference, const MinkowskiSimplex& nearest)
{
    Polytope polytope(difference);
    if (!polytope.start())
        return {-difference.m_core.rounding(), flatDirection(difference, polytope.m_flatNormal),
                nearest.softBarycentric()};
    while (polytope.expand())
    {
    }
    return polytope.result();
}

}  // namespace bullet_fem
