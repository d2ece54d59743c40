// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/triangle_overlap.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

/// A convex polyhedron: its corners, and the directions of its edges and face normals.
template <int Corners, int Edges, int Normals>
struct Solid
{
    std::array<Vec3, Corners> m_corners;
    std::array<Vec3, Edges> m_edges;
    std::array<Vec3, Normals> m_normals;
};

template <std::size_t N>
void project(const std::array<Vec3, N>& points, const Vec3& axis, double& low, double& high)
{
    low = high = dot(points[0], axis);
    for (std::size_t i = 1; i < N; ++i)
    {
        const double s = dot(points[i], axis);
        low = std::min(low, s);
        high = std::max(high, s);
    }
}

template <typename SolidType>
bool meets(const TriangleCorners& triangle, const SolidType& solid, double slack)
{
    const auto apart = [&](const Vec3& axis)
    {
        const double length = norm(axis);
        if (length < 1e-14) return false;  // parallel edges or a degenerate triangle: no direction
        double lowA, highA, lowB, highB;
        project(triangle, axis, lowA, highA);
        project(solid.m_corners, axis, lowB, highB);
        return std::max(lowA - highB, lowB - highA) > slack * length;
    };
    for (const Vec3& normal : solid.m_normals)
        if (apart(normal)) return false;
    const Vec3 sides[] = {triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]};
    if (apart(cross(sides[0], sides[1]))) return false;
    for (const Vec3& side : sides)
        for (const Vec3& edge : solid.m_edges)
            if (apart(cross(side, edge))) return false;
    return true;
}

}  // namespace

bool triangleMeetsBox(const TriangleCorners& triangle, const Vec3& low, const Vec3& high, double slack)
{
    constexpr std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    Solid<8, 3, 3> box{{}, axes, axes};
    for (int c = 0; c < 8; ++c)
        box.m_corners[c] = {c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z};
    return meets(triangle, box, slack);
}

bool triangleMeetsTet(const TriangleCorners& triangle, const std::array<Vec3, 4>& tet, double slack)
{
    const Vec3 a = tet[1] - tet[0], b = tet[2] - tet[0], c = tet[3] - tet[0];
    return meets(triangle,
                 Solid<4, 6, 4>{
                     tet, {a, b, c, b - a, c - a, c - b}, {cross(a, b), cross(b, c), cross(c, a), cross(b - a, c - a)}},
                 slack);
}

TetRegion::TetRegion(const std::array<Vec3, 4>& tet, double slack) : m_low(tet[0]), m_high(tet[0])
{
    for (int i = 0; i < 4; ++i)
    {
        const Vec3 &a = tet[(i + 1) % 4], &b = tet[(i + 2) % 4], &c = tet[(i + 3) % 4];
        m_normals[i] = cross(b - a, c - a);
        const double inner = dot(m_normals[i], tet[i] - a);
        if (inner > 0) m_normals[i] = -m_normals[i];
        m_offsets[i] = dot(m_normals[i], a);
        if (slack > 0) m_offsets[i] += slack * norm(m_normals[i]);
        for (int axis = 0; axis < 3; ++axis)
        {
            m_low[axis] = std::min(m_low[axis], tet[i][axis]);
            m_high[axis] = std::max(m_high[axis], tet[i][axis]);
        }
    }
    m_low -= {slack, slack, slack};
    m_high += {slack, slack, slack};
}

bool TetRegion::mayMeet(const Vec3& low, const Vec3& high) const
{
    for (int a = 0; a < 3; ++a)
        if (low[a] > m_high[a] || high[a] < m_low[a]) return false;
    for (int i = 0; i < 4; ++i)
    {
        const Vec3& n = m_normals[i];
        const Vec3 deepest = {n.x > 0 ? low.x : high.x, n.y > 0 ? low.y : high.y, n.z > 0 ? low.z : high.z};
        if (dot(n, deepest) > m_offsets[i]) return false;
    }
    return true;
}

}  // namespace bullet_fem
