// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/triangle_tree.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace bullet_fem
{
namespace
{

constexpr int kLeafSize = 4;
constexpr double kRayRounding = 1e-9;  // relative, along a ray: for boxes without thickness

/// a / b, or 0 if b is 0, in triangles without area.
double ratio(double a, double b)
{
    return b != 0 ? a / b : 0;
}

/// The nearest point of a triangle, by the Voronoi regions of its corners, edges and face [Ericson 2005, 5.1.5].
Vec3 nearestOn(const TriangleCorners& t, const Vec3& p)
{
    const Vec3 ab = t[1] - t[0], ac = t[2] - t[0];
    const double d1 = dot(ab, p - t[0]), d2 = dot(ac, p - t[0]);
    if (d1 <= 0 && d2 <= 0) return t[0];
    const double d3 = dot(ab, p - t[1]), d4 = dot(ac, p - t[1]);
    if (d3 >= 0 && d4 <= d3) return t[1];
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + ab * ratio(d1, d1 - d3);
    const double d5 = dot(ab, p - t[2]), d6 = dot(ac, p - t[2]);
    if (d6 >= 0 && d5 <= d6) return t[2];
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + ac * ratio(d2, d2 - d6);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return t[1] + (t[2] - t[1]) * ratio(d4 - d3, (d4 - d3) + (d5 - d6));
    return t[0] + ab * ratio(vb, va + vb + vc) + ac * ratio(vc, va + vb + vc);
}

double squaredDistance(const Vec3& low, const Vec3& high, const Vec3& p)
{
    double sum = 0;
    for (int a = 0; a < 3; ++a)
    {
        const double d = std::max({low[a] - p[a], p[a] - high[a], 0.0});
        sum += d * d;
    }
    return sum;
}

/// Parameter s of the ray's intersection with the triangle, negative if there is none [Moeller & Trumbore 1997]; rays
/// through an edge meet both of its triangles.
double alongRay(const TriangleCorners& t, const Vec3& from, const Vec3& way)
{
    constexpr double kOnEdgeWeight = -1e-9;
    const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], p = cross(way, ac);
    const double determinant = dot(ab, p);
    if (determinant == 0) return -1;
    const double u = dot(from - t[0], p) / determinant;
    if (!(u >= kOnEdgeWeight && u <= 1 - kOnEdgeWeight)) return -1;
    const Vec3 q = cross(from - t[0], ab);
    const double v = dot(way, q) / determinant;
    if (!(v >= kOnEdgeWeight && u + v <= 1 - kOnEdgeWeight)) return -1;
    return dot(ac, q) / determinant;
}

// Sign of a number, by symbolic perturbation if rounding gives 0: the line is moved by (d, d^2, d^3), d > 0 arbitrarily
// small, which changes the number by its gradient times that [Edelsbrunner & Muecke 1990, simulation of simplicity].
bool isPositive(double number, const Vec3& gradient)
{
    for (const double n : {number, gradient.x, gradient.y, gradient.z})
        if (n != 0) return n > 0;
    return false;
}

/// True if the line passes the edge a b on its left, seen along the line. Edges shared by triangles are evaluated in
/// one direction, so that both triangles get equal answers despite rounding.
bool isLeft(const Vec3& from, const Vec3& way, const Vec3& a, const Vec3& b)
{
    const auto key = [](const Vec3& x) { return std::make_tuple(x.x, x.y, x.z); };
    const bool swapped = key(b) < key(a);
    const Vec3 &first = swapped ? b : a, &second = swapped ? a : b;
    return isPositive(dot(way, cross(first - from, second - from)), cross(way, second - first)) != swapped;
}

/// 1 if the segment crosses the triangle along its normal, -1 against it, 0 if it does not.
int crossing(const TriangleCorners& t, const Vec3& from, const Vec3& to)
{
    const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    const bool begins = isPositive(dot(from - t[0], normal), normal), ends = isPositive(dot(to - t[0], normal), normal);
    if (begins == ends) return 0;
    const Vec3 way = to - from;
    const bool left = isLeft(from, way, t[0], t[1]);
    if (isLeft(from, way, t[1], t[2]) != left || isLeft(from, way, t[2], t[0]) != left) return 0;
    return ends ? 1 : -1;
}

/// True if part of a ray is in a box.
bool rayMeetsBox(const Vec3& low, const Vec3& high, const Ray& ray)
{
    double first = ray.m_first, last = ray.m_last;
    for (int a = 0; a < 3; ++a)
    {
        if (ray.m_way[a] == 0)
        {
            if (ray.m_from[a] < low[a] || ray.m_from[a] > high[a]) return false;
            continue;
        }
        const auto [in, out] =
            std::minmax({(low[a] - ray.m_from[a]) / ray.m_way[a], (high[a] - ray.m_from[a]) / ray.m_way[a]});
        first = std::max(first, in - kRayRounding);
        last = std::min(last, out + kRayRounding);
    }
    return first <= last;
}

}  // namespace

TriangleTree::TriangleTree(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles)
{
    for (const Triangle& t : triangles) m_triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
    build(0, static_cast<int>(m_triangles.size()));
}

void TriangleTree::build(int first, int last)
{
    const std::size_t self = m_nodes.size();
    Node node{m_triangles[first][0], m_triangles[first][0], first, last, 0, 0};
    for (int t = first; t < last; ++t)
        for (const Vec3& x : m_triangles[t])
            for (int a = 0; a < 3; ++a)
            {
                node.m_low[a] = std::min(node.m_low[a], x[a]);
                node.m_high[a] = std::max(node.m_high[a], x[a]);
            }
    m_nodes.push_back(node);
    if (last - first <= kLeafSize)
    {
        m_nodes[self].m_skip = static_cast<int>(self) + 1;
        return;
    }
    // Splits along the axis of the largest extent of the triangles' centres: splitting by boxes would not separate long
    // triangles side by side.
    const auto middleOf = [](const TriangleCorners& t) { return t[0] + t[1] + t[2]; };
    Vec3 least = middleOf(m_triangles[first]), most = least;
    for (int t = first; t < last; ++t)
        for (int a = 0; a < 3; ++a)
        {
            least[a] = std::min(least[a], middleOf(m_triangles[t])[a]);
            most[a] = std::max(most[a], middleOf(m_triangles[t])[a]);
        }
    const Vec3 extent = most - least;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const int middle = first + (last - first) / 2;
    const auto along = [axis](const TriangleCorners& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
    std::nth_element(m_triangles.begin() + first, m_triangles.begin() + middle, m_triangles.begin() + last,
                     [&](const TriangleCorners& s, const TriangleCorners& t) { return along(s) < along(t); });
    build(first, middle);
    m_nodes[self].m_right = static_cast<int>(m_nodes.size());
    build(middle, last);
    m_nodes[self].m_skip = static_cast<int>(m_nodes.size());
}

Vec3 TriangleTree::nearest(const Vec3& p) const
{
    Vec3 best = m_triangles[0][0];
    double bestSquared = dot(best - p, best - p);
    nearestIn(0, p, best, bestSquared);
    return best;
}

void TriangleTree::nearestIn(int at, const Vec3& p, Vec3& best, double& bestSquared) const
{
    const Node& node = m_nodes[at];
    if (node.m_right == 0)
    {
        for (int t = node.m_first; t < node.m_last; ++t)
        {
            const Vec3 q = nearestOn(m_triangles[t], p);
            const double squared = dot(q - p, q - p);
            if (squared < bestSquared) best = q, bestSquared = squared;
        }
        return;
    }
    int nearer = at + 1, farther = node.m_right;
    double d1 = squaredDistance(m_nodes[nearer].m_low, m_nodes[nearer].m_high, p);
    double d2 = squaredDistance(m_nodes[farther].m_low, m_nodes[farther].m_high, p);
    if (d2 < d1) std::swap(nearer, farther), std::swap(d1, d2);
    if (d1 < bestSquared) nearestIn(nearer, p, best, bestSquared);
    if (d2 < bestSquared) nearestIn(farther, p, best, bestSquared);
}

bool TriangleTree::entersTet(const std::array<Vec3, 4>& tet, double depth) const
{
    const TetRegion region(tet, std::max(0.0, -depth));
    for (std::size_t n = 0; n < m_nodes.size();)
    {
        const Node& node = m_nodes[n];
        if (!region.mayMeet(node.m_low, node.m_high))
        {
            n = node.m_skip;
            continue;
        }
        if (node.m_right == 0)
            for (int t = node.m_first; t < node.m_last; ++t)
                if (triangleMeetsTet(m_triangles[t], tet, -depth)) return true;
        ++n;
    }
    return false;
}

int TriangleTree::crossings(const Vec3& from, const Vec3& to) const
{
    Vec3 low, high;
    for (int a = 0; a < 3; ++a)
    {
        low[a] = std::min(from[a], to[a]);
        high[a] = std::max(from[a], to[a]);
    }
    int sum = 0;
    for (std::size_t n = 0; n < m_nodes.size();)
    {
        const Node& node = m_nodes[n];
        if (node.m_low.x > high.x || node.m_high.x < low.x || node.m_low.y > high.y || node.m_high.y < low.y ||
            node.m_low.z > high.z || node.m_high.z < low.z)
        {
            n = node.m_skip;
            continue;
        }
        if (node.m_right == 0)
            for (int t = node.m_first; t < node.m_last; ++t) sum += crossing(m_triangles[t], from, to);
        ++n;
    }
    return sum;
}

RayHit TriangleTree::firstAlong(const Ray& ray) const
{
    RayHit hit{-1, {}};
    Ray rest = ray;
    for (std::size_t n = 0; n < m_nodes.size();)
    {
        const Node& node = m_nodes[n];
        if (!rayMeetsBox(node.m_low, node.m_high, rest))
        {
            n = node.m_skip;
            continue;
        }
        if (node.m_right == 0)
            for (int t = node.m_first; t < node.m_last; ++t)
            {
                const TriangleCorners& x = m_triangles[t];
                const double along = alongRay(x, ray.m_from, ray.m_way);
                if (!(along >= rest.m_first && along < rest.m_last)) continue;
                rest.m_last = along;
                hit = {along, cross(x[1] - x[0], x[2] - x[0])};
            }
        ++n;
    }
    return hit;
}

}  // namespace bullet_fem
