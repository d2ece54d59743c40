// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A wedge of height 1.5 L above its sharp edge along y, 1 L long and .8 L wide.
inline TetMesh makeWedge(double L)
{
    constexpr int kLayers = 3;
    std::vector<Vec3> X;
    std::vector<Tet> tets;
    for (int k = 0; k <= kLayers; ++k)
    {
        const double y = L * (double(k) / kLayers - 0.5);
        X.insert(X.end(), {{-0.4 * L, y, 1.5 * L}, {0.4 * L, y, 1.5 * L}, {0, y, 0}});
    }
    for (int a = 0; a < 3 * kLayers; a += 3)
        tets.insert(tets.end(), {{a, a + 1, a + 2, a + 5}, {a, a + 1, a + 4, a + 5}, {a, a + 3, a + 4, a + 5}});
    return TetMesh(X, tets);
}

/// A spike of height 1.5 L above its tip, with a square top of .8 L.
inline TetMesh makeSpike(double L)
{
    const double r = 0.4 * L, z = 1.5 * L;
    return TetMesh({{-r, -r, z}, {r, -r, z}, {r, r, z}, {-r, r, z}, {0, 0, 0}, {0, 0, z}},
                   {{0, 1, 5, 4}, {1, 2, 5, 4}, {2, 3, 5, 4}, {3, 0, 5, 4}});
}

/// A horizontal rectangle, which may be a line or a point.
struct Rectangle
{
    double m_x0, m_x1, m_y0, m_y1;  ///< [m]
};

/// A convex solid between two rectangles: a block, a spike, a wedge, a frustum.
class SharpSolid
{
public:
    /// Adds triangles of faces that are not degenerate.
    SharpSolid(const Rectangle& bottom, double low, const Rectangle& top, double high)
    {
        for (int k = 0; k < 8; ++k)
        {
            const Rectangle& r = k < 4 ? bottom : top;
            m_corners[k] = {k & 1 ? r.m_x1 : r.m_x0, k & 2 ? r.m_y1 : r.m_y0, k < 4 ? low : high};
            m_middle += 0.125 * m_corners[k];
        }
        constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
        for (const auto& face : kFaces)
        {
            add(face[0], face[1], face[2]);
            add(face[0], face[2], face[3]);
        }
    }

    SharpSolid scaled(double scale) const
    {
        SharpSolid result = *this;
        for (Vec3& x : result.m_triangles) x = scale * x;
        for (auto& plane : result.m_planes) plane[0] = scale * plane[0];
        return result;
    }

    /// Corners of its triangles, three each [m].
    const std::vector<Vec3>& triangles() const { return m_triangles; }

    /// Depth of a point inside; negative outside [m].
    double depthOf(const Vec3& p) const
    {
        double depth = std::numeric_limits<double>::infinity();
        for (const auto& [on, normal] : m_planes) depth = std::min(depth, -dot(normal, p - on));
        return depth;
    }

private:
    void add(int a, int b, int c)
    {
        const Vec3 &p = m_corners[a], &q = m_corners[b], &r = m_corners[c];
        const Vec3 area = cross(q - p, r - p);
        if (!(norm(area) > 0)) return;
        const Vec3 normal = (dot(area, m_middle - p) > 0 ? -1 : 1) / norm(area) * area;
        m_planes.push_back({p, normal});
        m_triangles.insert(m_triangles.end(), {p, q, r});
    }

    std::array<Vec3, 8> m_corners;  // as made
    Vec3 m_middle;
    std::vector<Vec3> m_triangles;
    std::vector<std::array<Vec3, 2>> m_planes;  // a point and the outward normal
};

/// Largest depth of a soft body's nodes inside a solid [m], at least 0.
inline double depthOfNodes(const btSoftBody& body, const SharpSolid& solid)
{
    double depth = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i) depth = std::max(depth, solid.depthOf(vec3(body.m_nodes[i].m_x)));
    return depth;
}

/// True if a point is inside one of the tetrahedra, as deformed.
inline bool isInside(const btSoftBody& body, const Vec3& p)
{
    for (int t = 0; t < body.m_tetras.size(); ++t)
    {
        Vec3 way[4];
        for (int a = 0; a < 4; ++a) way[a] = vec3(body.m_tetras[t].m_n[a]->m_x) - p;
        const double volume = dot(cross(way[1] - way[0], way[2] - way[0]), way[3] - way[0]);
        const double parts[4] = {dot(cross(way[1], way[2]), way[3]), -dot(cross(way[0], way[2]), way[3]),
                                 dot(cross(way[0], way[1]), way[3]), -dot(cross(way[0], way[1]), way[2])};
        if (volume > 0 && *std::min_element(parts, parts + 4) > 0) return true;
    }
    return false;
}

/// Depth of a point below the nearest plane of a soft body's surface [m]; 0 if it is not inside.
inline double depthInside(const btSoftBody& body, const Vec3& p)
{
    if (!isInside(body, p)) return 0;
    double depth = std::numeric_limits<double>::infinity();
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        Vec3 x[3];
        for (int a = 0; a < 3; ++a) x[a] = vec3(body.m_faces[f].m_n[a]->m_x);
        const Vec3 area = cross(x[1] - x[0], x[2] - x[0]);
        depth = std::min(depth, std::fabs(dot(area, p - x[0])) / norm(area));
    }
    return depth;
}

/// Largest depth of points of a solid's edges inside a soft body [m].
inline double depthOfEdges(const btSoftBody& body, const SharpSolid& solid)
{
    constexpr int kPoints = 10;  // on each edge
    Vec3 low = vec3(body.m_nodes[0].m_x), high = low;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        for (int c = 0; c < 3; ++c)
        {
            low[c] = std::min(low[c], double(body.m_nodes[i].m_x[c]));
            high[c] = std::max(high[c], double(body.m_nodes[i].m_x[c]));
        }
    double depth = 0;
    const std::vector<Vec3>& x = solid.triangles();
    for (std::size_t k = 0; k < x.size(); ++k)
        for (int j = 0; j <= kPoints; ++j)
        {
            const Vec3& to = x[k % 3 == 2 ? k - 2 : k + 1];
            const Vec3 p = x[k] + (double(j) / kPoints) * (to - x[k]);
            bool isNear = true;
            for (int c = 0; c < 3; ++c) isNear = isNear && p[c] > low[c] && p[c] < high[c];
            if (isNear) depth = std::max(depth, depthInside(body, p));
        }
    return depth;
}

}  // namespace bullet_fem
