// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cmath>

#include "bullet_bridge/contact/rigid/sheet_contact.h"

namespace bullet_fem
{

namespace
{

constexpr double kFlatSine = 1e-3;       // smallest sine by which a tip or ridge falls off [-]
constexpr double kHardlyRises = 0.1;     // largest rise around a tip or ridge over its fall [-]
constexpr double kParallelEdges = 1e-3;  // sine of the angle between edges that count as parallel [-]
constexpr double kOutsideOfCone = 0.05;  // tolerance of a normal outside the cone of a soft edge's normals [-]

/// Calls visit(index) for the triangles near a feature's corners, along their outward direction by the reach and inward
/// by the depth. `spread`: sine of the largest deviation from that direction.
template <class Visit>
void forEachNear(const TriangleSoup& soup, const SheetFeature& feature, double spread, Visit visit)
{
    const double outside = feature.m_reach + feature.m_thickness;
    const Vec3 ways[2] = {outside * feature.m_outward, -feature.m_depth * feature.m_outward};
    Vec3 low = feature.m_corners[0] + ways[0], high = low;
    for (const Vec3& corner : feature.m_corners)
        for (const Vec3& way : ways)
            for (int c = 0; c < 3; ++c)
            {
                low[c] = std::min(low[c], corner[c] + way[c]);
                high[c] = std::max(high[c], corner[c] + way[c]);
            }
    const double pad = spread * std::max(outside, feature.m_depth);
    soup.forEachIn(low - Vec3{pad, pad, pad}, high + Vec3{pad, pad, pad}, visit);
}

bool isWithin(const SheetFeature& feature, double gap)
{
    return gap - feature.m_thickness <= feature.m_reach && gap >= -feature.m_depth;
}

/// True if a surface that rises and falls by at most these sines around a point stands out there: soft faces are seldom
/// exactly parallel to a top whose corners they lie on.
bool standsOut(double rise, double fall)
{
    return fall > kFlatSine && rise <= kHardlyRises * fall;
}

/// True if corner q of a triangle is a tip: the triangles around it fall off along `direction`, and hardly rise against
/// it. True only for the triangle of smallest index among those that share the corner.
bool isTip(const TriangleSoup& soup, int triangle, const Vec3& q, const Vec3& direction)
{
    bool isFirst = true;
    double rise = 0, fall = 0;
    const auto check = [&](int t)
    {
        for (const Vec3& corner : soup.triangles()[t].m_corners)
        {
            const Vec3 way = corner - q;
            const double length = norm(way);
            const double beyond = dot(way, direction);
            if (length <= soup.tolerance())
                isFirst = isFirst && t >= triangle;
            else
            {
                rise = std::max(rise, -beyond / length);
                fall = std::max(fall, beyond / length);
            }
        }
    };
    check(triangle);
    if (rise > kHardlyRises) return false;  // no sine of a fall is larger than 1
    soup.forEachAround(q, check);
    return isFirst && standsOut(rise, fall);
}

/// The crossing of a soft edge and an edge of the soup.
struct EdgeCrossing
{
    Vec3 m_point;   ///< on the soup's edge [m]
    Vec3 m_along;   ///< unit, along the soup's edge
    Vec3 m_normal;  ///< unit, towards the soft edge
    double m_gap = 0;
    double m_softShare = 0;  ///< barycentric weight of the soft edge's second corner [-]
};

/// False if the edges do not cross, if the normal is outside the soft edge's cone, or if edge e of the triangle does
/// not stand out.
bool crossEdges(const SheetFeature& soft, const Corners& triangle, int e, EdgeCrossing& crossing)
{
    const Vec3 &from = triangle[e], &to = triangle[(e + 1) % 3];
    const Vec3 softWay = soft.m_corners[1] - soft.m_corners[0], way = to - from;
    Vec3 n = cross(softWay, way);
    const double length = norm(n), outward = dot(n, soft.m_outward);
    if (!(std::abs(outward) >= widestNormal(soft) * length) || length == 0) return false;
    n *= (outward > 0 ? -1 : 1) / length;
    const Vec3 beside = triangle[(e + 2) % 3] - from;
    if (!(dot(n, beside) < 0)) return false;  // rejects most candidates, so it comes before costlier tests

    LineParameters at;
    if (!nearestOfLines({soft.m_corners[0], soft.m_corners[1], from, to}, kParallelEdges, at)) return false;
    if (!(at.m_a > 0 && at.m_a < 1 && at.m_b > 0 && at.m_b < 1)) return false;
    crossing.m_normal = n;
    crossing.m_point = from + at.m_b * way;
    crossing.m_along = way * (1 / norm(way));
    crossing.m_gap = dot(n, soft.m_corners[0] + at.m_a * softWay - crossing.m_point);
    crossing.m_softShare = at.m_a;
    return isWithin(soft, crossing.m_gap);
}

/// True if the triangle falls off from its edge at the crossing, and those beside the edge hardly rise. True only for
/// the triangle of smallest index among those that fall off.
bool isRidge(const TriangleSoup& soup, int triangle, const EdgeCrossing& crossing)
{
    bool isFirst = true;
    double rise = 0, fall = 0;
    const auto check = [&](int t)
    {
        int onEdge = 0;
        bool falls = false;
        for (const Vec3& corner : soup.triangles()[t].m_corners)
        {
            const Vec3 way = corner - crossing.m_point;
            if (norm(cross(way, crossing.m_along)) <= soup.tolerance())
                ++onEdge;
            else
            {
                const double above = dot(way, crossing.m_normal) / norm(way);
                rise = std::max(rise, above);
                fall = std::max(fall, -above);
                falls = falls || -above > kFlatSine;
            }
        }
        isFirst = isFirst && (onEdge < 2 || !falls || t >= triangle);
    };
    check(triangle);
    if (!(fall > kFlatSine) || rise > kHardlyRises) return false;
    soup.forEachAround(crossing.m_point, check);
    return isFirst && standsOut(rise, fall);
}

}  // namespace

double widestNormal(const SheetFeature& edge)
{
    return std::max(0.2, edge.m_halfAngle - kOutsideOfCone);
}

void findCornerContacts(const TriangleSoup& soup, const SheetFeature& soft, std::vector<SheetContact>& touches)
{
    touches.clear();
    const auto consider = [&](int t, const Vec3& q)
    {
        const double gap = dot(soft.m_outward, q - soft.m_corners[0]);
        std::array<double, 3> w;
        if (!isWithin(soft, gap) || !projectOnPlane(soft.m_corners, q, w) || !(std::min({w[0], w[1], w[2]}) > 0))
            return;
        if (isTip(soup, t, q, soft.m_outward)) touches.push_back({{gap - soft.m_thickness, -soft.m_outward, w}, t});
    };
    forEachNear(soup, soft, 0,
                [&](int t)
                {
                    for (const Vec3& corner : soup.triangles()[t].m_corners) consider(t, corner);
                });
}

void findEdgeContacts(const TriangleSoup& soup, const SheetFeature& soft, std::vector<SheetContact>& touches)
{
    touches.clear();
    const auto consider = [&](int t, int e)
    {
        EdgeCrossing crossing;
        if (!crossEdges(soft, soup.triangles()[t].m_corners, e, crossing) || !isRidge(soup, t, crossing)) return;
        const double b = crossing.m_softShare;
        touches.push_back({{crossing.m_gap - soft.m_thickness, crossing.m_normal, {1 - b, b, 0}}, t});
    };
    const double cosine = widestNormal(soft);
    forEachNear(soup, soft, std::sqrt(1 - cosine * cosine),
                [&](int t)
                {
                    for (int e = 0; e < 3; ++e) consider(t, e);
                });
}

}  // namespace bullet_fem
